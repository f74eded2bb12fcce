// The ledger of errors adds up on the samples: every source has a number on both sides, no
// measured one above its prediction, and the predicted bounds cover what the cut surface
// of the program shows, gouge and left material.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands/run.h"
#include "app/process/ledger_sources.h"

namespace toothpath {
namespace {

class Ledger : public testing::TestWithParam<const char*> {};

TEST_P(Ledger, CoversWhatIsMeasured) {
  const auto out = std::filesystem::temp_directory_path() / (std::string("toothpath_ledger_") + GetParam());
  std::filesystem::remove_all(out);
  commands::RunRequest request;
  request.job_file = std::string(TOOTHPATH_SOURCE_DIR) + "/samples/" + GetParam() + ".toml";
  request.out_dir = out.string();
  request.quiet = true;
  const auto outcome = commands::run_job(request);
  ASSERT_TRUE(outcome.errors.empty()) << outcome.errors.front().message;
  const auto report = nlohmann::json::parse(outcome.report_json);
  std::filesystem::remove_all(out);
  // The tools of the samples reach all of their gears: no remark beside the verdict, and no warning of a corner 0.000
  // mm high.
  EXPECT_EQ(report["verdict"], "verified");
  for (const auto& warning : report["warnings"])
    EXPECT_EQ(warning.get<std::string>().find("finishing ball"), std::string::npos) << warning;
  double sum = 0;
  for (const auto& [source, entry] : report["ledger"].items()) {
    ASSERT_TRUE(entry["predicted"].is_number()) << source;
    if (source == "deflection") {  // a model: it says so, and is no part of the sum
      EXPECT_TRUE(entry["model_only"].get<bool>());
      EXPECT_NE(entry["note"].get<std::string>().find("not measured"), std::string::npos);
      continue;
    }
    ASSERT_TRUE(entry["measured"].is_number()) << source;
    EXPECT_GE(entry["predicted"].get<double>(), 0) << source;
    EXPECT_GE(entry["measured"].get<double>(), 0) << source;
    EXPECT_TRUE(entry.contains("note")) << source;
    EXPECT_LE(entry["measured"].get<double>(), entry["predicted"].get<double>()) << source << ": " << entry["note"];
    if (source != "ridge") sum += entry["predicted"].get<double>();
  }
  for (const char* source :
       {"flank solve", "chord", "orientation", "axis linearisation", "rounding", "path blending", "verification"})
    EXPECT_TRUE(report["ledger"].contains(source)) << source;
  const auto& finished = report["excess_um"]["finished"];
  EXPECT_GE(sum, report["gouge_um"]["measured"].get<double>()) << "gouge";
  EXPECT_GE(sum, -finished["min"].get<double>()) << "gouge on the grid";
  EXPECT_GE(sum, finished["max"].get<double>()) << "left material";
}

INSTANTIATE_TEST_SUITE_P(Samples, Ledger,
                         testing::Values("spur_quick", "offset_milled", "dhfg_ball", "dhfg_t600s", "dhfg_paper",
                                         "short_tool", "bevel_pinion", "bevel_trunnion", "bevel_wheel", "tool_axis"),
                         [](const auto& c) { return std::string(c.param); });

// Without TCP blocks leave the chord where a rotary turns; with it the control keeps the tip there, and the rotary
// turns all the same.
TEST(LedgerOfTheMachine, SaysWhoKeepsTheTipOnItsChord) {
  const auto note = [](machines::TcpMode tcp, bool turns, double chord_mm) {
    joints::AxisProgram program;
    program.tcp = tcp;
    program.turns_in_cuts = turns;
    program.chord_bound_mm = chord_mm;
    std::vector<proof::LedgerEntry> ledger;
    process::add_machine_sources(ledger, program, {}, {}, 0);
    return ledger.front().note;
  };
  using machines::TcpMode;
  EXPECT_NE(note(TcpMode::none, true, 1e-4).find("blocks against the chords"), std::string::npos);
  EXPECT_NE(note(TcpMode::angles, true, 0).find("keeps the tip on the chord (TCP)"), std::string::npos);
  EXPECT_NE(note(TcpMode::vectors, true, 0).find("a rotary axis turns"), std::string::npos);
  EXPECT_NE(note(TcpMode::angles, false, 0).find("no rotary axis turns"), std::string::npos);
  EXPECT_NE(note(TcpMode::none, false, 0).find("no rotary axis turns"), std::string::npos);
}

}  // namespace
}  // namespace toothpath
