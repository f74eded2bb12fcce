// A short job in every dialect, byte for byte as it stands in tests/golden/posts. TOOTHPATH_WRITE_GOLDEN=1 writes the
// files anew: a deliberate act, to be explained block by block.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/postproc/text/post_forms.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

struct Golden {
  const char* file;
  const char* dialect;
  machines::TcpMode tcp;
  double swing;
  bool expand;
  int teeth = 2, stride = 1, steps = 3, rollover = 0;
};
void PrintTo(const Golden& g, std::ostream* out) { *out << g.file; }

class GoldenPost : public testing::TestWithParam<Golden> {};
INSTANTIATE_TEST_SUITE_P(
    Files, GoldenPost,
    testing::Values(Golden{"linuxcnc_joints.ngc", "linuxcnc", machines::TcpMode::none, 0.1, false},
                    Golden{"linuxcnc_tcp.ngc", "linuxcnc", machines::TcpMode::angles, 0.1, true},
                    Golden{"linuxcnc_tcp_turned.ngc", "linuxcnc", machines::TcpMode::angles, 0.1, false},
                    Golden{"fanuc_joints.nc", "fanuc", machines::TcpMode::none, 0, false},
                    Golden{"fanuc_tcp.nc", "fanuc", machines::TcpMode::angles, 0.1, true},
                    Golden{"mitsubishi_m80.nc", "mitsubishi_m80", machines::TcpMode::none, 0, false},
                    Golden{"fanuc_tcp_called.nc", "fanuc", machines::TcpMode::angles, 0.1, false},
                    Golden{"haas.nc", "haas", machines::TcpMode::none, 0.1, true},
                    Golden{"haas_called.nc", "haas", machines::TcpMode::none, 0.1, false},
                    Golden{"siemens_joints.mpf", "siemens", machines::TcpMode::none, 0.1, false},
                    Golden{"siemens_tcp.mpf", "siemens", machines::TcpMode::angles, 0.1, false},
                    Golden{"siemens_vectors.mpf", "siemens", machines::TcpMode::vectors, 0.1, false},
                    Golden{"heidenhain_joints.h.txt", "heidenhain", machines::TcpMode::none, 0, false},
                    Golden{"heidenhain_tcp.h.txt", "heidenhain", machines::TcpMode::angles, 0, false},
                    Golden{"heidenhain_tcp_moving.h.txt", "heidenhain", machines::TcpMode::angles, 0.1, false},
                    Golden{"heidenhain_vectors.h.txt", "heidenhain", machines::TcpMode::vectors, 0.1, true},
                    Golden{"cutter_location.apt", "apt", machines::TcpMode::vectors, 0.1, true},
                    Golden{"linuxcnc_spread.ngc", "linuxcnc", machines::TcpMode::none, 0.1, false, 5, 2, 1},
                    Golden{"fanuc_spread.nc", "fanuc", machines::TcpMode::none, 0, false, 5, 2, 1},
                    Golden{"siemens_spread.mpf", "siemens", machines::TcpMode::angles, 0.1, false, 5, 2, 1},
                    Golden{"heidenhain_spread.h.txt", "heidenhain", machines::TcpMode::angles, 0, false, 5, 2, 1},
                    Golden{"linuxcnc_rollover.ngc", "linuxcnc", machines::TcpMode::none, 0.1, false, 5, 1, 1, -1},
                    Golden{"fanuc_rollover.nc", "fanuc", machines::TcpMode::none, 0, false, 5, 1, 1, -1},
                    Golden{"siemens_rollover.mpf", "siemens", machines::TcpMode::angles, 0.1, false, 5, 1, 1, -1},
                    Golden{"heidenhain_rollover.h.txt", "heidenhain", machines::TcpMode::angles, 0, false, 5, 1, 1,
                           -1}));

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
