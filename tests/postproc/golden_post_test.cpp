// A short job in every dialect, byte for byte as it stands in tests/golden/posts. TOOTHPATH_WRITE_GOLDEN=1 writes the files anew:
// a deliberate act, to be explained block by block.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/postproc/post_forms.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

struct Golden {
  const char* file;
  const char* dialect;
  TcpMode tcp;
  double swing;
  bool expand;
  int teeth = 2, stride = 1, steps = 3, rollover = 0;
};
void PrintTo(const Golden& g, std::ostream* out) { *out << g.file; }

class GoldenPost : public testing::TestWithParam<Golden> {};
INSTANTIATE_TEST_SUITE_P(Files, GoldenPost,
                         testing::Values(Golden{"linuxcnc_joints.ngc", "linuxcnc", TcpMode::none, 0.1, false},
                                         Golden{"linuxcnc_tcp.ngc", "linuxcnc", TcpMode::angles, 0.1, true},
                                         Golden{"fanuc_joints.nc", "fanuc", TcpMode::none, 0, false},
                                         Golden{"fanuc_tcp.nc", "fanuc", TcpMode::angles, 0.1, true},
                                         Golden{"mitsubishi_m80.nc", "mitsubishi_m80", TcpMode::none, 0, false},
                                         Golden{"haas.nc", "haas", TcpMode::none, 0.1, true},
                                         Golden{"siemens_joints.mpf", "siemens", TcpMode::none, 0.1, false},
                                         Golden{"siemens_tcp.mpf", "siemens", TcpMode::angles, 0.1, false},
                                         Golden{"siemens_vectors.mpf", "siemens", TcpMode::vectors, 0.1, false},
                                         Golden{"heidenhain_joints.h", "heidenhain", TcpMode::none, 0, false},
                                         Golden{"heidenhain_tcp.h", "heidenhain", TcpMode::angles, 0, false},
                                         Golden{"heidenhain_vectors.h", "heidenhain", TcpMode::vectors, 0.1, true},
                                         Golden{"cutter_location.apt", "apt", TcpMode::vectors, 0.1, true},
                                         Golden{"linuxcnc_spread.ngc", "linuxcnc", TcpMode::none, 0.1, false, 5, 2, 1},
                                         Golden{"fanuc_spread.nc", "fanuc", TcpMode::none, 0, false, 5, 2, 1},
                                         Golden{"siemens_spread.mpf", "siemens", TcpMode::angles, 0.1, false, 5, 2, 1},
                                         Golden{"heidenhain_spread.h", "heidenhain", TcpMode::angles, 0, false, 5, 2, 1},
                                         Golden{"linuxcnc_rollover.ngc", "linuxcnc", TcpMode::none, 0.1, false, 5, 1, 1, -1},
                                         Golden{"fanuc_rollover.nc", "fanuc", TcpMode::none, 0, false, 5, 1, 1, -1},
                                         Golden{"siemens_rollover.mpf", "siemens", TcpMode::angles, 0.1, false, 5, 1, 1, -1},
                                         Golden{"heidenhain_rollover.h", "heidenhain", TcpMode::angles, 0, false, 5, 1, 1, -1}));

TEST_P(GoldenPost, ByteForByte) {
  const Golden& g = GetParam();
  const PostForm form{g.dialect, g.tcp, g.swing, g.expand, g.rollover};
  const auto program = program_of(form, {sample_path(0.3, g.swing, g.steps)}, g.teeth, g.stride);
  ASSERT_TRUE(program) << program.error().message;
  const auto text = text_of(form, *program);
  ASSERT_TRUE(text) << text.error().message;
  const std::string file = std::string(TOOTHPATH_SOURCE_DIR) + "/tests/golden/posts/" + g.file;
  if (std::getenv("TOOTHPATH_WRITE_GOLDEN") != nullptr) write_file(file, text->text);
  ASSERT_NE(text->text, "");
  EXPECT_EQ(text->text, file_text(file)) << file;
}

}  // namespace
}  // namespace toothpath
