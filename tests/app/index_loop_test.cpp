// A machine file that asks for the teeth in a loop: it is followed, or its line says why not.
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

/// The warnings of the quick sample on `machine` with `index_loop`, and whether the text has a loop.
struct Loop {
  std::string warnings;
  std::size_t lines = 0;
};
Loop run_with(const std::string& index_loop, const std::string& tcp, const std::string& origin) {
  const TestDir dir;
  std::string machine = replaced(file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml"), "tcp = \"none\"",
                                 "tcp = \"" + tcp + "\"");
  machine += "\n[post]\n" + index_loop + "\ntcp_on = [\"M428\"]\ntcp_off = [\"M429\"]\n";
  write_file(dir / "m.toml", machine);
  std::string job = replaced(file_text(kSamples + "/spur_quick.toml"), "xyzac_large.toml", "m.toml");
  write_file(dir / "job.toml", replaced(job, "origin = [3.0, -2.0, 120.0]", "origin = " + origin));
  const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  Loop out;
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  for (const auto& warning : report["warnings"])
    if (warning.get<std::string>().find("index_loop") != std::string::npos)
      out.warnings += warning.get<std::string>().substr(dir.path().size() + 1) + "\n";
  const std::string text = file_text(dir / "out/program.ngc");
  out.lines = std::size_t(std::count(text.begin(), text.end(), '\n'));
  return out;
}

TEST(IndexLoop, IsFollowedOrSaysWhyNot) {
  const std::string on_axis = "[3.0, -2.0, 120.0]", off_axis = "[4.0, -2.0, 120.0]";
  const Loop followed = run_with("index_loop = true", "none", on_axis);
  EXPECT_EQ(followed.warnings, "");
  EXPECT_LT(followed.lines, 3000u);
  const Loop under_tcp = run_with("index_loop = true", "angles", on_axis);
  EXPECT_GT(under_tcp.lines, 30000u);
  EXPECT_EQ(
      under_tcp.warnings,
      "m.toml:55:14: post.index_loop = true is not followed, every tooth is written out: with TCP this control turns "
      "a work offset, and post.index_offset names none that programs may overwrite\n");
  const Loop turned = run_with("index_loop = true\nindex_offset = \"G59.3\"", "angles", on_axis);
  EXPECT_EQ(turned.warnings, "");
  EXPECT_LT(turned.lines, 3000u);
  EXPECT_NE(run_with("index_loop = true", "none", off_axis).warnings.find("the gear does not turn about its own axis"),
            std::string::npos);
  // Nobody asked.
  EXPECT_EQ(run_with("", "angles", on_axis).warnings, "");
  EXPECT_EQ(run_with("index_loop = false", "angles", on_axis).warnings, "");
}

}  // namespace
}  // namespace toothpath::test
