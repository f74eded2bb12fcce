// Whole runs whose tools are checked at a setter: from the job to the proven bytes, what report and sheet say, parts
// and restart, `check` of what somebody edits, and what is refused.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

struct CheckedRun {
  const char* machine;
  const char* extension;
  const char* lines;   ///< of [tool_check]; empty: those of the control
  const char* words;   ///< of a check in the text
  const char* length;  ///< line that says the length again, the first of it
};
std::ostream& operator<<(std::ostream& out, const CheckedRun& c) { return out << c.machine; }

constexpr const char* kTable = "position = [350.0, 340.0, 60.0]\ntolerance = 0.05\ntime = 12.0\n";

/// A machine that ships, with a tool setter.
void write_machine(const TestDir& dir, const CheckedRun& c, const std::string& table = kTable) {
  std::string text = file_text(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + c.machine + ".toml");
  text = replaced(text, "\n[limits]", "\n[tool_check]\n" + table + c.lines + "\n[limits]");
  write_file(dir / "machine.toml", text);
}
std::string tool_checks_job(const std::string& program, const std::string& tool = "") {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  text = replaced(text, "#:schema ../docs/schema/job.schema.json\n", "");
  text = replaced(text, "\"xyzac_large.toml\"", "\"machine.toml\"\naccept_assumed = true");
  text = replaced(text, "[3.0, -2.0, 120.0]", "[0.0, 0.0, 30.0]");
  text = replaced(text, "[3.0, -2.0, 0.0]", "[0.0, 0.0, 0.0]");
  text = replaced(text, "inner_radius = 60.0", "inner_radius = 62.0");
  if (!tool.empty()) text = replaced(text, "stick_out = 16.0\n", "stick_out = 16.0\n" + tool + "\n");
  return text + "\n[program]\n" + program + "\n";
}
Finished run_in(const TestDir& dir, const std::string& folder = "out", std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"run", dir / "job.toml", "--out", dir / folder};
  words.insert(words.end(), more.begin(), more.end());
  return run_program({words});
}
const CheckedRun kFanuc = {"fanuc_ac", "nc", "lines = [\"G65 P9858 T{tool}. H{tolerance}\"]\n", "G65 P9858 T1. H0.05",
                           "G0 G43.4 H1"};

class ToolChecksRun : public ::testing::TestWithParam<CheckedRun> {};
INSTANTIATE_TEST_SUITE_P(
    Run, ToolChecksRun,
    ::testing::Values(kFanuc,
                      CheckedRun{"m80_ac", "nc", "lines = [\"G65 P9858 T{tool}. H{tolerance}\"]\n",
                                 "G65 P9858 T1. H0.05", "G0 G43 H1"},
                      CheckedRun{"haas_ac", "nc", "lines = [\"G65 P9023 A21. T{tool}. H{tolerance}\"]\n",
                                 "G65 P9023 A21. T1. H0.05", "G0 G43 H1"},
                      CheckedRun{"siemens_ac", "mpf", "lines = [\"TOOL_CHECK({tool},{tolerance})\"]\n",
                                 "TOOL_CHECK(1,0.05)", "D1"},
                      CheckedRun{"xyzac_large", "ngc", "", "G91 G38.3 Z[0-2*10] F100", "G43 H1"},
                      CheckedRun{"heidenhain_ac", "h", "", "TCH PROBE 481 TOOL LENGTH Q340=+2", "TOOL CALL 1 Z S"}));

TEST_P(ToolChecksRun, IsVerifiedAndWhatIsEditedIsFound) {
  const CheckedRun& c = GetParam();
  const TestDir dir;
  write_machine(dir, c);
  write_file(dir / "job.toml", tool_checks_job("tool_check = \"none\""));
  const Finished without = run_in(dir, "plain");
  ASSERT_EQ(without.exit_code, 0) << without.err << without.out;
  const std::string plain = file_text(dir / (std::string("plain/program.") + c.extension));
  EXPECT_EQ(times_in(plain, c.words), 0U);
  write_file(dir / "job.toml", tool_checks_job("tool_check = \"teeth\"\ntool_check_teeth = 25"));
  const Finished run = run_in(dir);
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const Json report = report_in(dir / "out"), before = report_in(dir / "plain");
  EXPECT_EQ(report["verified"], true);
  // Two operations of three stretches, and behind the last.
  ASSERT_EQ(report["tool_checks"].size(), 1U);
  EXPECT_EQ(report["tool_checks"][0]["tool"], 1);
  EXPECT_EQ(report["tool_checks"][0]["checks"], 7);
  EXPECT_DOUBLE_EQ(report["tool_checks"][0]["tolerance"], 0.05);
  EXPECT_FALSE(before.contains("tool_checks"));
  EXPECT_NEAR(report["total_minutes"].get<double>() - before["total_minutes"].get<double>(), 7 * 12.0 / 60, 0.2);
  EXPECT_NE(report["warnings"].dump().find("tool_check: it is trusted that the lines move no rotary"),
            std::string::npos);
  const std::string program = file_text(dir / (std::string("out/program.") + c.extension));
  EXPECT_EQ(times_in(program, c.words), 7U);
  const std::string sheet = file_text(dir / "out/setup.html");
  EXPECT_NE(sheet.find("Checks of the tools"), std::string::npos);
  EXPECT_NE(sheet.find("X 350 Y 340 Z 60 mm machine"), std::string::npos);

  const auto checked = [&](const std::string& text) {
    write_file(dir / "edited", text);
    return run_program({"check", dir / "job.toml", dir / "edited", "--out", dir / "checked"});
  };
  const auto as_it_is = checked(program);
  EXPECT_EQ(as_it_is.exit_code, 0) << as_it_is.err << as_it_is.out;
  // The length is not said again behind the second check.
  const std::size_t second = program.find(c.words, program.find(c.words) + 1);
  const std::size_t length = program.find(c.length, second);
  ASSERT_NE(length, std::string::npos);
  std::string edited = program;
  edited.replace(length, edited.find('\n', length) - length, std::string(c.extension) == "h" ? "; LEFT OUT" : "");
  const auto unsaid = checked(edited);
  EXPECT_EQ(unsaid.exit_code, 3) << unsaid.out;
  EXPECT_NE(unsaid.err.find("edited:"), std::string::npos) << unsaid.err;
  // Without its checks the program is as good as one without them, and the job asks for them.
  const auto bare = checked(plain);
  EXPECT_EQ(bare.exit_code, 0) << bare.err << bare.out;
  EXPECT_NE((bare.out + bare.err).find("cuts with T1, which no check has met since it came"), std::string::npos)
      << bare.out << bare.err;
  const std::size_t tolerance = program.find("0.05", program.find("TOOL CHECK T1 WITHIN 0.05 MM") + 28);
  edited = program;
  edited.replace(tolerance, 4, "0.5");
  const auto wide = checked(edited);
  EXPECT_EQ(wide.exit_code, 3) << wide.out;
  EXPECT_NE(wide.err.find("lets 0.5 mm pass, limit 0.05"), std::string::npos) << wide.err;
}

// Restart and parts begin with a check of the tool that they go on with.
TEST(ToolChecksOfRuns, RestartsAndParts) {
  const TestDir dir;
  write_machine(dir, kFanuc);
  write_file(dir / "job.toml", tool_checks_job("tool_check = \"tool_changes\"\nteeth_per_program = 30"));
  const Finished run = run_in(dir);
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_EQ(times_in(file_text(dir / "out/program.nc"), kFanuc.words), 2U);
  for (int part = 1; part <= 4; ++part)
    EXPECT_EQ(times_in(file_text(dir / fmt::format("out/program_{}.nc", part)), kFanuc.words), 2U) << part;
  const Finished again = run_in(dir, "again", {"--restart", "1:30"});
  ASSERT_EQ(again.exit_code, 0) << again.err << again.out;
  const std::string program = file_text(dir / "again/program.nc");
  EXPECT_EQ(times_in(program, kFanuc.words), 2U);
  EXPECT_LT(program.find(kFanuc.words), program.find("M98"));
}

// Where the setter stands in the way of the part, the way there is none.
TEST(ToolChecksOfRuns, TheWayToTheSetterIsProven) {
  const TestDir dir;
  write_machine(dir, kFanuc, "position = [64.0, 0.0, -15.0]\ntolerance = 0.05\n");
  write_file(dir / "job.toml", tool_checks_job("tool_check = \"operations\""));
  const Finished run = run_in(dir);
  EXPECT_EQ(run.exit_code, 1) << run.out;
  EXPECT_NE(run.err.find("line"), std::string::npos) << run.err;
  write_machine(dir, kFanuc, "position = [350.0, 340.0, 600.0]\ntolerance = 0.05\n");
  const Finished high = run_in(dir, "high");
  EXPECT_EQ(high.exit_code, 3) << high.out;
  EXPECT_NE(high.err.find("tool 1 is too long for the tool setter: with its tip 10 mm above it Z would be 690.0000"),
            std::string::npos)
      << high.err;
}

// A length that the control takes as it was measured counts in the ledger and in the verdict.
TEST(ToolChecksOfRuns, AnUncertaintyIsARowOfTheLedger) {
  const TestDir dir;
  write_file(dir / "job.toml", tool_checks_job("tool_check = \"tool_changes\""));
  double bound = 0;
  for (const double um : {0.0, 0.1, 50.0}) {
    write_machine(dir, kFanuc, kTable + fmt::format("uncertainty = {}\n", um / 1000));
    const Finished run = run_in(dir);
    if (um == 50) {
      EXPECT_EQ(run.exit_code, 1) << run.out;
      continue;
    }
    ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
    const Json report = report_in(dir / "out");
    const std::string ledger = report["ledger"].dump();
    EXPECT_EQ(ledger.find("tool length") != std::string::npos, um > 0) << ledger;
    const double now = report["gouge_um"]["bound"].get<double>();
    if (um > 0) { EXPECT_NEAR(now, bound + um, 0.02); }
    bound = now;
  }
}

TEST(ToolChecksOfRuns, WhatIsNotSaidIsRefused) {
  const TestDir dir;
  const auto told = [&](const std::string& program, const std::string& tool = "") {
    write_file(dir / "job.toml", tool_checks_job(program, tool));
    const Finished run = run_in(dir, "none");
    EXPECT_EQ(run.exit_code, 3) << run.out;
    return run.err;
  };
  write_machine(dir, kFanuc, "position = [350.0, 340.0, 60.0]\n");
  EXPECT_NE(told("tool_check = \"tool_changes\"").find("nothing says how far its length may be off"),
            std::string::npos);
  EXPECT_NE(told("tool_check = \"tool_changes\"", "check_tolerance = 0.0004")
                .find("a tolerance of 0.0004 mm is below 0.001, the last digit of this control"),
            std::string::npos);
  CheckedRun fixed = kFanuc;
  fixed.lines = "lines = [\"G65 P9858 T{tool}.\"]\n";
  write_machine(dir, fixed);
  EXPECT_NE(told("tool_check = \"tool_changes\"", "check_tolerance = 0.02").find("name no {tolerance}, they let 0.05"),
            std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
