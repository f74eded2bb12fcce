// Whole runs on machines whose C rolls over, from the job to the proven bytes; the tool axis passes the pole, so that C
// turns in the cuts.
#include <nlohmann/json.hpp>

#include <regex>

#include "tests/app/pole_job.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

struct RolloverCase {
  const char* machine;
  const char* extension;
  const char* word;  ///< rotary words of C, the number as the first group
  const char* note;  ///< in the header
};
std::ostream& operator<<(std::ostream& out, const RolloverCase& c) { return out << c.machine; }

class RolloverRun : public ::testing::TestWithParam<RolloverCase> {};
INSTANTIATE_TEST_SUITE_P(Run, RolloverRun,
                         ::testing::Values(RolloverCase{"xyzac_large", "ngc", R"( C(-?[\d.]+))",
                                                        "(C ROLLS OVER: [AXIS_C] WRAPPED_ROTARY = 1)"},
                                           RolloverCase{
                                               "fanuc_ac", "nc", R"( C(-?[\d.]+))",
                                               "(C ROLLS OVER: PARAMETERS 1008#0 ROA=1, 1008#1 RAB=0, 1260=360.)"},
                                           RolloverCase{"siemens_ac", "mpf", R"( C=DC\(ABS\(R2\+([\d.]+)-360\*TRUNC)",
                                                        ";C ROLLS OVER: MODULO AXIS, 30310=1, 30330=360"},
                                           RolloverCase{"heidenhain_ac", "h", R"( C([+-][\d.]+))",
                                                        "; C ROLLS OVER: MODULO AXIS, DISPLAY BELOW 360"}));

/// A machine that ships, its C without ends.
std::string without_ends(const std::string& machine) {
  const std::string text = file_text(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + machine + ".toml");
  const std::size_t c = text.find("[axes.C]");
  const std::string rest = std::regex_replace(text.substr(c), std::regex("min = [-\\d.]+\nmax = [-\\d.]+\n"),
                                              "rollover = true\n", std::regex_constants::format_first_only);
  return text.substr(0, c) + rest;
}

TEST_P(RolloverRun, IsVerifiedAndReadBack) {
  const RolloverCase& c = GetParam();
  const TestDir dir;
  write_file(dir / (std::string(c.machine) + "_endless.toml"), without_ends(c.machine));
  PoleJob job;
  job.pole = "slow";
  job.aside_deg = 0.3;
  job.machine = std::string(c.machine) + "_endless.toml";
  write_file(dir / "job.toml", job_text(job));
  const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_NE(run.out.find("rolls over"), std::string::npos) << run.out;
  const Json report = Json::parse(file_text(dir / "out/report.json"));
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["axes"]["C"]["rolls_over"], true);
  EXPECT_FALSE(report["axes"]["C"].contains("limit"));
  EXPECT_TRUE(report["axes"]["A"].contains("limit"));

  const std::string program = file_text(dir / (std::string("out/program.") + c.extension));
  EXPECT_NE(program.find(c.note), std::string::npos) << program.substr(0, 1500);
  std::size_t words = 0;
  const std::regex word(c.word);
  const std::string code = std::regex_replace(program, std::regex("\n\\([^\n]*"), "");  // a hash may look like a word
  for (std::sregex_iterator it(code.begin(), code.end(), word), end; it != end; ++it) {
    ++words;
    EXPECT_LT(std::abs(std::stod((*it)[1])), 360);
  }
  EXPECT_GT(words, 100u);

  if (std::string(c.machine) == "fanuc_ac")
    return;  // all teeth are written out and proven one by one: the run has done that
  const auto check = run_program(
      {"check", dir / "job.toml", dir / (std::string("out/program.") + c.extension), "--out", dir / "checked"});
  EXPECT_EQ(check.exit_code, 0) << check.err << check.out;
}

}  // namespace
}  // namespace toothpath::test
