// Numbers that are too small or too large for tools, control and words: refused at their keys, and what the message
// names as enough is enough.
#include <fmt/format.h>

#include <regex>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

const std::string kLinuxCnc = "file = \"xyzac_large.toml\"";

Finished run_text(const TestDir& dir, const std::string& text) {
  write_file(dir / "job.toml", text);
  return run_program({"run", dir / "job.toml", "--out", dir / "out", "--quiet"});
}

/// Refused at the key, exit code 3: the number ahead of `does` in the message.
std::string number_that(const TestDir& dir, const std::string& job, const std::string& key, const std::string& does) {
  const Finished refused = run_text(dir, job);
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/report.json"));
  std::smatch m;
  const std::regex form("job\\.toml:[1-9][0-9]*:[1-9][0-9]*: error: " + key + " = .* ([0-9.e-]+)( mm)? " + does);
  if (!std::regex_search(refused.err, m, form)) ADD_FAILURE() << refused.err;
  return m.empty() ? "" : m[1].str();
}

TEST(LeastValues, AGougeToleranceThatControlAndWordsTakeUp) {
  const TestDir dir;
  const auto job = [](const std::string& mm) {
    return replaced(file_text(kQuick), "gouge_tolerance = 0.002", "gouge_tolerance = " + mm);
  };
  const std::string least = number_that(dir, job("0.0006"), "gouge_tolerance", "or more does");
  EXPECT_LT(std::stod(least), 0.001);
  const Finished run = run_text(dir, job(least));
  EXPECT_EQ(run.exit_code, 0) << least << "\n" << run.err;
}

TEST(LeastValues, AnAllowanceOfAFewStepsOfTheWords) {
  const TestDir dir;
  const auto job = [](const std::string& mm) {
    return replaced(file_text(kQuick), "[[operation]]\ntype = \"finishing\"",
                    "[[operation]]\ntype = \"semi_finishing\"\ntool = 1\nspeed = 20000\nfeed = 500.0\nscallop = 0.03\n"
                    "allowance = " +
                        mm + "\n\n[[operation]]\ntype = \"finishing\"");
  };
  const std::string least = number_that(dir, job("0.00015"), "allowance", "or more does");
  EXPECT_LT(std::stod(least), 0.001);
  const Finished run = run_text(dir, job(least));
  EXPECT_EQ(run.exit_code, 0) << least << "\n" << run.err;
}

// Every tooth has its own words here: nearly the first one's, but the flute was taken to stray by all of it.
TEST(LeastValues, TeethOfWordsOfThreeDecimalsAreProvenToTheirOwnDepth) {
  const TestDir dir;
  std::string job =
      replaced(file_text(kSamples + "/flank_grid_spur.toml"), "gouge_tolerance = 0.003", "gouge_tolerance = 0.0013");
  job = replaced(job, kLinuxCnc, "file = \"fanuc_ac.toml\"\naccept_assumed = true");
  write_file(dir / "flank_grid_spur.csv", file_text(kSamples + "/flank_grid_spur.csv"));
  const Finished run = run_text(dir, replaced(job, "scallop = 0.004", "scallop = 0.02"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(LeastValues, AGougeToleranceThatNoFingerMillKeeps) {
  const TestDir dir;
  for (const char* machine : {"file = \"xyzac_trt.toml\"", "file = \"fanuc_ac.toml\""}) {
    const bool small = std::string(machine).find("trt") != std::string::npos;
    const auto job = [&](const std::string& mm) {
      const std::string text = replaced(
          replaced(file_text(kSamples + "/bevel_trunnion.toml"), "gouge_tolerance = 0.002", "gouge_tolerance = " + mm),
          "file = \"xyzac_trt.toml\"", machine);
      return small ? text : replaced_all(text, "[0.0, 0.0, 20.0]", "[0.0, 0.0, 120.0]");
    };
    const std::string least = number_that(dir, job("0.0006"), "gouge_tolerance", "or more does");
    const Finished run = run_text(dir, job(least));
    EXPECT_EQ(run.exit_code, 0) << machine << ": " << least << "\n" << run.err;
  }
}

TEST(LeastValues, AClearanceThatNoFingerMillKeeps) {
  const TestDir dir;
  const auto job = [](const std::string& mm) {
    return replaced(file_text(kSamples + "/bevel_trunnion.toml"), "gouge_tolerance = 0.002",
                    "gouge_tolerance = 0.002\nclearance = " + mm);
  };
  const std::string most = number_that(dir, job("0.5"), "clearance", "or less does");
  EXPECT_GT(std::stod(most), 0.1);
  const Finished run = run_text(dir, job(most));
  EXPECT_EQ(run.exit_code, 0) << most << "\n" << run.err;
}

// Refused before anything is planned where the tip does not rise over the part as it is mounted.
TEST(LeastValues, APartThatStandsTooHighForTheTopOfZ) {
  const TestDir dir;
  const auto job = [](double z) {
    const std::string at = fmt::format("[3.0, -2.0, {:.3f}]", z);
    return replaced(replaced(file_text(kQuick), "origin = [3.0, -2.0, 120.0]", "origin = " + at),
                    "work_offset_at = [3.0, -2.0, 0.0]", "work_offset_at = " + at);
  };
  const auto refused = [&](double z) {
    const Finished run = run_text(dir, job(z));
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_FALSE(std::filesystem::exists(dir / "out/report.json"));
    std::smatch m;
    const std::regex high(
        "job\\.toml:[0-9]+:[0-9]+: error: setup\\.origin = .* is ([0-9.]+) mm higher than the tip of T1");
    EXPECT_TRUE(std::regex_search(run.err, m, high)) << run.err;
    return m.empty() ? 0.0 : std::stod(m[1]);
  };
  const double higher = refused(600);
  EXPECT_NEAR(refused(600 - higher + 0.5), 0.5, 2e-3);
  const Finished run = run_text(dir, job(600 - higher - 0.001));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace toothpath::test
