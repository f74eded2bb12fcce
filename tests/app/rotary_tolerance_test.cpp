// What a control may do with its rotaries (TA of cycle 32) counts over the whole tool: a program with a larger one
// loses the clearance of its shank.
#include <nlohmann/json.hpp>

#include "tests/app/pole_job.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

TEST(RotaryTolerance, ALargerOneTakesTheClearanceOfTheShank) {
  const TestDir dir;
  PoleJob job;
  job.machine = "heidenhain_ac.toml";
  job.pole = "slow";
  job.aside_deg = 0.3;
  std::string text = replaced(job_text(job), "flute_length = 6.0", "flute_length = 2.0");
  text = replaced(text, "gouge_tolerance = 0.003", "gouge_tolerance = 0.003\nclearance = 0.5");
  write_file(dir / "job.toml", text);
  const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const std::string program = file_text(dir / "out/program.h");

  double least = 1;
  for (const char* tolerance : {"TA0.01", "TA1"}) {
    write_file(dir / "program.h", replaced(program, "TA0.01", tolerance));
    const auto check = run_program({"check", dir / "job.toml", dir / "program.h", "--out", dir / "checked"});
    const auto report = nlohmann::json::parse(file_text(dir / "checked/report.json"));
    const double clearance = report["clearance"]["least"];
    const bool told = report.dump().find("clearance of shank and holder") != std::string::npos;
    EXPECT_LT(clearance, least) << tolerance;
    least = clearance;
    EXPECT_EQ(told, std::string(tolerance) != "TA0.01") << check.err;
    EXPECT_EQ(check.exit_code == 0, !told) << check.err;
    if (told) {
      EXPECT_LT(clearance, 0.5);
      EXPECT_NE(report.dump().find("is below 0.5000 mm; shank against"), std::string::npos) << report["reasons"];
    }
  }
}

}  // namespace
}  // namespace toothpath::test
