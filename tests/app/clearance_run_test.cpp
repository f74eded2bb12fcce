// The least clearance as it is told: a gap that was measured, or that it is at least as large as was looked for.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

nlohmann::json told(const std::string& job, const TestDir& dir, Finished& run) {
  run = run_program({"run", job, "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return nlohmann::json::parse(file_text(dir / "out/report.json"))["clearance"];
}

TEST(ClearanceRun, AtLeastWhereTheProofStoppedLooking) {
  const TestDir dir;
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  write_file(dir / "job.toml", text);
  Finished run;
  auto clearance = told(dir / "job.toml", dir, run);
  EXPECT_EQ(clearance["at_least"], true);
  EXPECT_TRUE(clearance["measured"].is_null()) << clearance;
  const std::string open = fmt::format("at least {:.3f}", clearance["least"].get<double>());
  EXPECT_NE(run.out.find("least clearance     " + open + " mm (neck, shank, holder)"), std::string::npos) << run.out;
  EXPECT_NE(file_text(dir / "out/report.html").find("Shank and holder keep " + open + " mm"), std::string::npos);

  // A shank of 3 mm that ends close above the teeth.
  write_file(dir / "job.toml", replaced(replaced(text, "flute_length = 6.0", "flute_length = 3.8"),
                                        "shank_diameter = 0.95", "shank_diameter = 3.0"));
  clearance = told(dir / "job.toml", dir, run);
  EXPECT_EQ(clearance["at_least"], false);
  const double least = clearance["least"], measured = clearance["measured"];
  EXPECT_GE(measured, least);
  EXPECT_LE(measured, least + 0.05);
  EXPECT_NE(run.out.find(fmt::format("least clearance     {:.3f} mm (neck", least)), std::string::npos) << run.out;
  EXPECT_EQ(file_text(dir / "out/report.html").find("at least"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
