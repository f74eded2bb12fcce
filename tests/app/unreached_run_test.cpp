// What a run tells of surface that the finishing ball does not reach: beside the verdict everywhere, and as the verdict
// where the job or the active flank asks for it.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

/// The quick sample with a ball of `diameter`, and with one more line under [verify].
std::string job_with_mill(const TestDir& dir, const std::string& diameter, const std::string& line = {}) {
  std::string text = replaced(file_text(kSamples + "/spur_quick.toml"), "diameter = 1.0", "diameter = " + diameter);
  text = replaced(text, "shank_diameter = 0.95", "shank_diameter = 0.9");
  write_file(dir / "job.toml", text + "\n" + line + "\n");
  return dir / "job.toml";
}

TEST(UnreachedRun, StandsBesideTheVerdictEverywhere) {
  const TestDir dir;
  const auto run = run_program({"run", job_with_mill(dir, "1.8"), "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = report_in(dir / "out");
  EXPECT_TRUE(report["verified"].get<bool>());
  EXPECT_EQ(report["verdict"], "verified, root not finished");
  const auto& u = report["unreached"];
  EXPECT_GT(u["points"].get<int>(), 100);
  EXPECT_GE(u["max_height_um"].get<double>(), 100);
  EXPECT_GE(u["height_um"].get<double>(), u["max_height_um"].get<double>());
  EXPECT_GT(u["share_percent"].get<double>(), 5);
  EXPECT_NEAR(u["largest_ball_mm"].get<double>(), 1.2, 0.01);  // a spur fillet: the diameter of the shaper's rounding
  EXPECT_EQ(u["ball_mm"], 1.8);
  EXPECT_TRUE(u["active_flank"].is_null());
  const std::string height = fmt::format("up to {:.3f} mm high", u["height_um"].get<double>() / 1000),
                    share = fmt::format("{:.1f} %", u["share_percent"].get<double>());
  EXPECT_NE(run.out.find("verified            yes, root not finished"), std::string::npos) << run.out;
  for (const std::string& text : {run.out, file_text(dir / "out/report.html"), file_text(dir / "out/setup.html")}) {
    EXPECT_NE(text.find("oot not finished"), std::string::npos);
    EXPECT_NE(text.find(height), std::string::npos) << height;
    EXPECT_NE(text.find(share), std::string::npos) << share;
    EXPECT_NE(text.find("the largest ball that reaches all of it has 1.20"), std::string::npos);
  }
  EXPECT_NE(file_text(dir / "out/report.html").find("class=\"verdict part\""), std::string::npos);
  // The number told is no figure of speech: that ball reaches everything.
  const std::string told = fmt::format("{:.3f}", std::floor(u["largest_ball_mm"].get<double>() * 1000) / 1000);
  ASSERT_EQ(run_program({"run", job_with_mill(dir, told, "unreached = 0"), "--out", dir / "out"}).exit_code, 0);
  EXPECT_EQ(report_in(dir / "out")["verdict"], "verified");
  EXPECT_EQ(report_in(dir / "out")["unreached"]["points"], 0);
}

TEST(UnreachedRun, IsAVerdictAboveTheKey) {
  const TestDir dir;
  ASSERT_EQ(run_program({"run", job_with_mill(dir, "1.8"), "--out", dir / "out"}).exit_code, 0);
  const double height = report_in(dir / "out")["unreached"]["height_um"].get<double>() / 1000;
  EXPECT_EQ(run_program({"run", job_with_mill(dir, "1.8", fmt::format("unreached = {:.6f}", height + 2e-6)), "--out",
                         dir / "out"})
                .exit_code,
            0);
  const auto run = run_program(
      {"run", job_with_mill(dir, "1.8", fmt::format("unreached = {:.6f}", height - 2e-6)), "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("([verify] unreached); the largest ball that reaches all of it has 1.20"), std::string::npos)
      << run.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
  EXPECT_EQ(report_in(dir / "out")["verdict"], "not verified");
  EXPECT_EQ(run_program({"run", job_with_mill(dir, "1.8", "unreached = 0"), "--out", dir / "out"}).exit_code, 1);
}

// The same program, asked again from its text.
TEST(UnreachedRun, CheckSaysTheSame) {
  const TestDir dir;
  const std::string job = job_with_mill(dir, "1.8");
  ASSERT_EQ(run_program({"run", job, "--out", dir / "out"}).exit_code, 0);
  const auto ran = report_in(dir / "out")["unreached"];
  const auto check = run_program({"check", job, dir / "out/program.ngc", "--out", dir / "checked"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.out.find("yes, root not finished"), std::string::npos) << check.out;
  EXPECT_EQ(nlohmann::json::parse(file_text(dir / "checked/report.json"))["unreached"], ran);
  EXPECT_EQ(run_program({"check", job_with_mill(dir, "1.8", "unreached = 0.1"), dir / "out/program.ngc", "--out",
                         dir / "checked"})
                .exit_code,
            1);
}

TEST(UnreachedRun, TheActiveFlankIsAlwaysAVerdict) {
  const TestDir dir;
  const auto run = run_program({"run", job_with_mill(dir, "2.2", "unreached = 50"), "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("does not reach the active flank"), std::string::npos) << run.err;
  EXPECT_FALSE(report_in(dir / "out")["unreached"]["active_flank"].is_null());
  EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
}

TEST(UnreachedRun, NothingIsSaidWhereTheBallFits) {
  const TestDir dir;
  const auto run = run_program({"run", kSamples + "/spur_quick.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = report_in(dir / "out");
  EXPECT_EQ(report["verdict"], "verified");
  // Of the ball nothing; that its neck is slender, and that it is small for roughing, are other matters.
  ASSERT_EQ(report["warnings"].size(), 2u) << report["warnings"];
  EXPECT_TRUE(report["warnings"][0].get<std::string>().starts_with("operation 0 roughs with tool 1, 1 mm; the upper"));
  EXPECT_TRUE(report["warnings"][1].get<std::string>().starts_with("tool 1 is slender")) << report["warnings"];
  EXPECT_EQ(run.out.find("not finished"), std::string::npos);
  EXPECT_EQ(file_text(dir / "out/report.html").find("oot not finished"), std::string::npos);
  EXPECT_EQ(file_text(dir / "out/setup.html").find("oot not finished"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
