// `--json` of every command carries its data, not only the verdict.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

using Words = std::vector<std::string>;

struct Asked {
  Words words;    ///< OUT: a folder
  Words pointer;  ///< what the data must have, as JSON pointers, not empty there
};

class CommandJson : public ::testing::TestWithParam<Asked> {};

TEST_P(CommandJson, CarriesTheDataOfTheCommand) {
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
    Commands, CommandJson,
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

/// Rows of a CSV file below its header; cells by the header's names.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
  const auto cells = [](const std::string& line) {
    Words out(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) out.emplace_back();
      else out.back() += c;
    }
    return out;
  };
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const Words names = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const Words row = cells(line);
    rows.emplace_back();
    for (std::size_t k = 0; k < names.size() && k < row.size(); ++k) rows.back()[names[k]] = row[k];
  }
  return rows;
}
/// As the file shows it: half a unit of its last digit.
void expect_shown(const nlohmann::json& value, const std::string& shown, const std::string& what) {
  const auto point = shown.find('.');
  const double unit = point == std::string::npos ? 1 : std::pow(0.1, double(shown.size() - point - 1));
  ASSERT_TRUE(value.is_number()) << what << ": " << value;
  EXPECT_NEAR(value.get<double>(), std::stod(shown), 0.5 * unit * (1 + 1e-6)) << what;
}

/// Its figures, from the deviations of all places.
TEST(JsonOfCompare, HasTheFiguresOfItsPlaces) {
  const TestDir dir;
  const auto report =
      report_of({"compare", kSamples + "/offset_shaped.toml", kSamples + "/offset_milled.toml", "--out", dir / "out"});
  const auto rows = rows_of(file_text(dir / "out/compare.csv"));
  ASSERT_EQ(report["flanks"].size(), 2U);
  for (const auto& flank : report["flanks"]) {
    for (const std::string of : {"shaped", "milled", "difference"}) {
      double least = INFINITY, greatest = -INFINITY;
      std::size_t points = 0;
      for (const auto& row : rows) {
        if (std::stoi(row.at("zone")) != flank["zone"] || std::stoi(row.at("flank")) != flank["flank"]) continue;
        const double um = std::stod(row.at(of + "_um"));
        least = std::min(least, um);
        greatest = std::max(greatest, um);
        ++points;
        EXPECT_NEAR(std::stod(row.at("milled_um")) - std::stod(row.at("shaped_um")), std::stod(row.at("difference_um")),
                    2e-4);
      }
      EXPECT_EQ(flank["points"], points);
      EXPECT_NEAR(flank[of]["min_um"], least, 6e-5) << of;
      EXPECT_NEAR(flank[of]["max_um"], greatest, 6e-5) << of;
      EXPECT_GT(flank[of]["rms_um"], 0) << of;
      EXPECT_LT(flank[of]["rms_um"], std::max(-least, greatest)) << of;
    }
  }
  ASSERT_EQ(report["contact"].size(), 4U) << "two flanks by two routes";
  const std::string page = file_text(dir / "out/compare.html");
  for (const auto& row : report["contact"]) {
    char shown[32];
    (void)std::snprintf(shown, sizeof shown, "%.3f", row["error_range_um"].get<double>());
    EXPECT_NE(page.find(shown), std::string::npos) << shown;
  }
  EXPECT_GT(report["milled"]["minutes"], report["milled"]["cutting_minutes"]);
}

TEST(JsonOfDhfg, HasTheNumbersOfItsTable) {
  const TestDir dir;
  const auto report = report_of({"study", "dhfg", "--quick", "--out", dir / "out"});
  const auto rows = rows_of(file_text(dir / "out/dhfg.csv"));
  ASSERT_EQ(rows.size(), 9U);
  ASSERT_EQ(report["trials"].size(), 9U);
  for (std::size_t k = 0; k < 9; ++k) {
    const auto& trial = report["trials"][k];
    EXPECT_EQ(std::to_string(trial["trial"].get<int>()), rows[k].at("trial"));
    for (const auto& [pointer, column] : {std::pair("/pinion_teeth", "N_p"),
                                          {"/teeth", "N_2"},
                                          {"/helix_deg", "helix deg"},
                                          {"/R1", "R1 mm"},
                                          {"/R2", "R2 mm"},
                                          {"/R2_land", "R2' mm"},
                                          {"/R_in", "R_in mm"},
                                          {"/R_g", "R_g mm"},
                                          {"/R_out", "R_out mm"},
                                          {"/half_face", "half mm"},
                                          {"/feasible_half_face", "feasible mm"},
                                          {"/contact_ratio/inner", "ratio inner"},
                                          {"/contact_ratio/outer", "ratio outer"},
                                          {"/contact_ratio/v_teeth", "ratio V-teeth"},
                                          {"/axial_N/single_helix", "axial single N"},
                                          {"/axial_N/outer_half", "axial halves N"},
                                          {"/axial_N/balanced", "axial balanced N"},
                                          {"/axial_N/held", "axial held N"}})
      expect_shown(trial.at(nlohmann::json::json_pointer(pointer)), rows[k].at(column), column);
    EXPECT_EQ(trial["R1_governed_by"], rows[k].at("governed by"));
    // What the halves do not take from each other.
    EXPECT_NEAR(trial["axial_N"]["inner_half"].get<double>() + trial["axial_N"]["outer_half"].get<double>(),
                trial["axial_N"]["balanced"].get<double>(), 1e-6);
  }
}

TEST(JsonOfStability, HasTheNumbersOfItsTable) {
  const TestDir dir;
  const auto report = report_of({"study", "stability", "--out", dir / "out"});
  const auto rows = rows_of(file_text(dir / "out/stability.csv"));
  ASSERT_EQ(report["cases"].size(), rows.size());
  ASSERT_GT(rows.size(), 90U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& one = report["cases"][k];
    for (const char* word : {"group", "case", "verdict", "reason"}) EXPECT_EQ(one[word], rows[k].at(word));
    if (rows[k].at("points").empty()) continue;
    EXPECT_EQ(std::to_string(one["points"].get<int>()), rows[k].at("points"));
    EXPECT_NEAR(one["error_mm"], std::stod(rows[k].at("error_mm")), 0.051 * double(one["error_mm"]))
        << rows[k].at("case");
  }
}

/// A flank that is 8 um too high everywhere: what was measured, and what of it the correction does not follow.
TEST(JsonOfCorrect, SaysWhatWasMeasuredAndWhatIsLeft) {
  const TestDir dir;
  const std::string job = kSamples + "/spur_quick.toml";
  (void)report_of({"surface", job, "--out", dir / "surface"});
  std::istringstream nominal(file_text(dir / "surface/inspection.csv"));
  std::string line, measured;
  for (bool header = true; std::getline(nominal, line); header = false)
    measured += line + (header ? ",deviation_um\n" : ",8\n");
  write_file(dir / "measured.csv", measured);
  const auto report = report_of({"correct", job, "--measured", dir / "measured.csv", "--out", dir / "out"});
  ASSERT_EQ(report["correction"].size(), 2U);
  for (const auto& flank : report["correction"]) {
    EXPECT_NEAR(flank["measured_max_um"], 8, 1e-6);
    EXPECT_NEAR(flank["measured_rms_um"], 8, 1e-6);
    EXPECT_LT(flank["residual_max_um"], 0.01) << "a constant is followed";
  }
  EXPECT_EQ(report["command"], "correct");
  EXPECT_TRUE(report["verified"]);
  EXPECT_EQ(nlohmann::json::parse(file_text(dir / "out/correction.json"))["flanks"].size(), 2U);
}

/// Every command of the help is one of those above, or one whose own test reads its JSON.
TEST(JsonOfCommands, AreAllAsked) {
  const std::string help = run_program(Words{"--help"}).out;
  for (const char* command : {"new", "fit", "run", "check", "correct", "surface", "shaper", "cutter", "forces",
                              "contact", "compare", "probe", "study", "machine", "reference", "man-page", "completion"})
    EXPECT_NE(help.find(std::string("\n  ") + command + " "), std::string::npos) << command;
  const auto at = help.find("Subcommands:");
  ASSERT_NE(at, std::string::npos);
  std::size_t commands = 0;
  for (std::size_t line = help.find('\n', at) + 1; help.compare(line, 2, "  ") == 0; line = help.find('\n', line) + 1)
    commands += help[line + 2] != ' ' ? 1 : 0;
  EXPECT_EQ(commands, 17U) << help;
  for (const Words& words : {Words{"man-page", "--json"}, {"completion", "bash", "--json"}})
    EXPECT_EQ(nlohmann::json::parse(run_program(words).out)["exit_code"], 0) << words[0];
}

}  // namespace
}  // namespace toothpath::test
