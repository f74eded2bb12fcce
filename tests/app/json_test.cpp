// `--json` of every command carries its data, not only the verdict.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Words = std::vector<std::string>;

nlohmann::json report_of(Words words, int exit_code = 0) {
  words.emplace_back("--json");
  const Finished done = run_program(words);
  EXPECT_EQ(done.exit_code, exit_code) << words.front() << ": " << done.err;
  const auto json = nlohmann::json::parse(done.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << done.out.substr(0, 300);
  EXPECT_EQ(json["exit_code"], exit_code);
  EXPECT_TRUE(json.contains("report")) << words.front() << " has no data";
  return json.value("report", nlohmann::json::object());
}

struct Asked {
  Words words;    ///< OUT: a folder
  Words pointer;  ///< what the data must have, as JSON pointers, not empty there
};

class Json : public ::testing::TestWithParam<Asked> {};

TEST_P(Json, CarriesTheDataOfTheCommand) {
  const TestDir dir;
  Words words = GetParam().words;
  for (std::string& word : words)
    if (word == "OUT") word = dir / "out";
  const auto report = report_of(words);
  for (const std::string& pointer : GetParam().pointer) {
    const nlohmann::json::json_pointer at(pointer);
    ASSERT_TRUE(report.contains(at)) << pointer << " in " << report.dump().substr(0, 500);
    EXPECT_FALSE(report.at(at).empty()) << pointer;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Commands, Json,
    ::testing::Values(
        Asked{{"run", kSamples + "/spur_quick.toml", "--out", "OUT"},
              {"/gouge_um/bound", "/operations/0", "/axes/X", "/ledger/chord"}},
        Asked{{"surface", kSamples + "/offset_milled.toml", "--out", "OUT"}, {"/limits/zones/0/flanks/0"}},
        Asked{{"surface", kSamples + "/bevel_wheel.toml", "--out", "OUT"}, {"/limits"}},
        Asked{{"shaper", kSamples + "/offset_shaped.toml", "--out", "OUT"}, {"/limits/zones/0", "/set_up"}},
        Asked{{"cutter", kSamples + "/bevel_pinion.toml", "--out", "OUT"}, {"/mills/0/module", "/dxf"}},
        Asked{{"forces", kSamples + "/bevel_pinion.toml", "--torque", "100", "--out", "OUT"}, {""}},
        Asked{{"contact", kSamples + "/spur_quick.toml", "--out", "OUT"}, {""}},
        Asked{{"machine", "list"}, {"/machines/0/file", "/machines/15"}},
        Asked{{"machine", "show", "t600s"}, {"/file", "/machine/axes/A/point", "/machine/limits/cutting_feed"}},
        Asked{{"machine", "show", "y514.toml"}, {"/machine/gears/teeth"}},
        Asked{{"machine", "test", "xyzac_trt", "--out", "OUT"}, {"/programs/0/moves", "/stations", "/point"}},
        Asked{{"reference", "job"}, {"/properties/gear", "/properties/tool/items"}},
        Asked{{"reference", "machine"}, {"/then/properties/stroke", "/else/properties/chain"}},
        Asked{{"study", "trace-model", kSamples + "/bevel_pinion.toml", "--out", "OUT"}, {""}}));

TEST(JsonOfCheck, CarriesTheProof) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  (void)report_of({"run", job, "--out", dir / "run"});
  const auto report = report_of({"check", job, dir / "run/program.ngc", "--out", dir / "check"});
  EXPECT_TRUE(report.contains("gouge_um"));
  EXPECT_FALSE(report["conditions"]["operations"].empty());
}

/// Every command of the help is one of those above, or one whose own test reads its JSON.
TEST(JsonOfCommands, AreAllAsked) {
  const std::string help = run_program(Words{"--help"}).out;
  for (const char* command : {"new", "run", "check", "correct", "surface", "shaper", "cutter", "forces", "contact",
                              "compare", "study", "machine", "reference"})
    EXPECT_NE(help.find(std::string("\n  ") + command + " "), std::string::npos) << command;
  const auto at = help.find("Subcommands:");
  ASSERT_NE(at, std::string::npos);
  std::size_t commands = 0;
  for (std::size_t line = help.find('\n', at) + 1; help.compare(line, 2, "  ") == 0; line = help.find('\n', line) + 1)
    commands += help[line + 2] != ' ' ? 1 : 0;
  EXPECT_EQ(commands, 13U) << help;
}

}  // namespace
}  // namespace toothpath::test
