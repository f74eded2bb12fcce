// Bevel gears from outside: run, then check of the program as it is and with planted faults.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

const std::string kBevelTrunnion = kSamples + "/bevel_trunnion.toml";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}
std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}
std::size_t line_with(const std::vector<std::string>& lines, const std::string& begin) {
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].starts_with(begin)) return i;
  ADD_FAILURE() << begin << " is not in the program";
  return 0;
}

/// A sample beside the axis of its rotary table: no loop of teeth.
std::string off_the_axis() {
  return replaced(file_text(kSamples + "/bevel_pinion.toml"), "origin = [3.0, -2.0, 260.0]",
                  "origin = [8.0, 4.0, 260.0]");
}

/// One run for all tests of this file.
class BevelCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TestDir;
    run_ = new Finished(run_program({"run", kBevelTrunnion, "--out", *dir_ / "run"}));
    report_ = new nlohmann::json(nlohmann::json::parse(file_text(*dir_ / "run/report.json"), nullptr, false));
  }
  static void TearDownTestSuite() {
    delete report_;
    delete run_;
    delete dir_;
  }
  static nlohmann::json check(const std::string& name, const std::vector<std::string>& program, int exit_code) {
    write_file(*dir_ / (name + ".ngc"), text_of(program));
    const Finished done = run_program({"check", kBevelTrunnion, *dir_ / (name + ".ngc"), "--out", *dir_ / name});
    EXPECT_EQ(done.exit_code, exit_code) << done.out << done.err;
    return nlohmann::json::parse(file_text(*dir_ / (name + "/report.json")), nullptr, false);
  }
  static std::vector<std::string> program() { return lines_of(file_text(*dir_ / "run/program.ngc")); }

  static TestDir* dir_;
  static Finished* run_;
  static nlohmann::json* report_;
};
TestDir* BevelCommand::dir_ = nullptr;
Finished* BevelCommand::run_ = nullptr;
nlohmann::json* BevelCommand::report_ = nullptr;

TEST_F(BevelCommand, RunIsVerifiedWithItsNumbers) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const auto& r = *report_;
  EXPECT_TRUE(r["verified"].get<bool>());
  EXPECT_LE(r["gouge_um"]["measured"].get<double>(), 1.0);
  EXPECT_LE(r["gouge_um"]["bound"].get<double>(), 2.0);
  EXPECT_LE(r["excess_um"]["finished"]["bound"].get<double>(), 0.5 + 1.5);
  EXPECT_LE(r["ridge_mm"]["reached"].get<double>(), r["ridge_mm"]["requested"].get<double>());
  const auto& cusps = r["scallop_um"];  // the ridges between passes are its cusps
  EXPECT_NEAR(cusps["requested"].get<double>(), 1e3 * r["ridge_mm"]["requested"].get<double>(), 1e-9);
  EXPECT_NEAR(cusps["reached_max"].get<double>(), 1e3 * r["ridge_mm"]["reached"].get<double>(), 1e-9);
  EXPECT_LE(cusps["reached_min"].get<double>(), cusps["reached_max"].get<double>());
  EXPECT_LT(r["clearance"]["least"].get<double>(), 1.0) << "shank above the tips";
  EXPECT_GE(r["clearance"]["measured"].get<double>(), r["clearance"]["least"].get<double>());
  EXPECT_LT(r["clearance"]["measured"].get<double>(), 1.0) << "at the tip edges beside the space";
}

TEST_F(BevelCommand, TwoAxesMoveAndTheReportSaysSo) {
  const auto& tilt = (*report_)["tilt"];
  EXPECT_EQ(tilt["simultaneous_axes"], 2);
  EXPECT_EQ(tilt["moving_axes"], "YC");
  for (const auto& d : tilt["directions"])
    EXPECT_NE(d["explanation"].get<std::string>().find("two simultaneous axes (YC) plus fixed tilt"), std::string::npos)
        << d["explanation"];
  EXPECT_NE(file_text(*dir_ / "run/report.html").find("two simultaneous axes"), std::string::npos);
}

TEST_F(BevelCommand, NoBallMillCodeRuns) {
  for (const char* stage : {"distance index", "cut surface", "compare the teeth"})
    EXPECT_FALSE((*report_)["stages"].contains(stage)) << stage;
}

TEST_F(BevelCommand, CheckSaysTheSameOfTheProgram) {
  const auto again = check("same", program(), 0);
  for (const char* key : {"measured", "bound"})
    EXPECT_NEAR(again["gouge_um"][key].get<double>(), (*report_)["gouge_um"][key].get<double>(), 1e-6) << key;
  EXPECT_NEAR(again["ridge_mm"]["reached"].get<double>(), (*report_)["ridge_mm"]["reached"].get<double>(), 1e-9);
  EXPECT_TRUE(std::filesystem::exists(*dir_ / "same/report.html"));
}

// What only a face gear can do is refused at the gear's type, whichever command asks for it; it was ignored by some.
TEST_F(BevelCommand, WhatOnlyAFaceGearCanDoIsRefused) {
  const std::string measured = *dir_ / "run/inspection.csv", program = *dir_ / "run/program.ngc",
                    out = *dir_ / "refused";
  const std::string at = ": error: type = \"equal_base_circle_bevel_gear\"";
  const std::pair<std::vector<std::string>, std::string> asked[] = {
      {{"correct", kBevelTrunnion, "--measured", measured}, " answers no measurement: its flanks are what one mill"},
      {{"check", kBevelTrunnion, program, "--measured", measured},
       " answers no measurement: its flanks are what one mill"},
      {{"contact", kBevelTrunnion, "--pinion-teeth", "20"}, ", but --pinion-teeth needs a face_gear"}};
  for (auto [words, said] : asked) {
    words.insert(words.end(), {"--out", out});
    const Finished done = run_program(words);
    EXPECT_EQ(done.exit_code, 3) << said;
    EXPECT_NE(done.err.find(at + said), std::string::npos) << done.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  const Finished mate = run_program({"contact", kSamples + "/spur_quick.toml", "--mate", kBevelTrunnion, "--out", out});
  EXPECT_EQ(mate.exit_code, 3);
  EXPECT_NE(mate.err.find("type = \"equal_base_circle_bevel_gear\" does not run with a face gear"), std::string::npos)
      << mate.err;
}

TEST_F(BevelCommand, WallPassesAloneLeaveARidge) {
  auto lines = program();
  const std::size_t first = line_with(lines, "(OP 0"), second = line_with(lines, "(OP 1");
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.begin() + static_cast<std::ptrdiff_t>(second));
  // The tool that the first operation called.
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(line_with(lines, "S14000 M3")), "T1 M6");
  const auto report = check("walls", lines, 1);
  EXPECT_GT(report["ridge_mm"]["reached"].get<double>(), 0.3);
  bool named = false;
  for (const auto& reason : report["reasons"]) named = named || reason.get<std::string>().starts_with("ridge: ");
  EXPECT_TRUE(named) << report["reasons"];
}

// One block of a wall pass turned by 0.05 deg one way or the other: one cuts into the wall and is named, the other
// leaves material.
TEST_F(BevelCommand, ATurnedBlockIsFound) {
  const std::regex word("C(-?[0-9.]+)");
  bool gouge = false, left = false;
  for (const double turn : {0.05, -0.05}) {
    auto lines = program();
    const std::size_t from = line_with(lines, "(OP 1");
    std::size_t at = from;
    int seen = 0;
    std::smatch m;
    for (; at < lines.size(); ++at)
      if (lines[at].find('Y') != std::string::npos && std::regex_search(lines[at], m, word) && ++seen == 25) break;
    ASSERT_LT(at, lines.size());
    char changed[64];
    std::snprintf(changed, sizeof changed, "C%.5f", std::stod(m[1].str()) + turn);
    lines[at] = m.prefix().str() + changed + m.suffix().str();
    const auto report = check(turn > 0 ? "plus" : "minus", lines, 1);
    for (const auto& reason : report["reasons"]) {
      if (reason.get<std::string>().starts_with("gouge: ")) gouge = true;
      if (reason.get<std::string>().starts_with("material left")) left = true;
    }
    if (report["gouge_um"]["bound"].get<double>() > 5) {
      const int line = report["worst_places"][0]["line"].get<int>();
      EXPECT_TRUE(line == static_cast<int>(at) + 1 || line == static_cast<int>(at) + 2) << line << " for " << at + 1;
    }
  }
  EXPECT_TRUE(gouge);
  EXPECT_TRUE(left);
}

// Danger 12: which axis of a diagonal rapid arrives first is not known. Rotaries with X Y, X Y with Z below the safe
// height, Z with a rotary behind the last tooth: each is a verdict with its line.
TEST_F(BevelCommand, DiagonalRapidsAreRefused) {
  const auto refused = [](const std::string& name, const std::vector<std::string>& lines, std::size_t at) {
    const auto report = check(name, lines, 1);
    const std::string reason = "line " + std::to_string(at + 1) + ": a rapid moves more than one group of axes";
    EXPECT_NE(std::find(report["reasons"].begin(), report["reasons"].end(), reason), report["reasons"].end())
        << name << " " << report["reasons"];
  };
  const auto clean = program();
  std::size_t second = 0;  // index of the second cut
  for (int seen = 0; second < clean.size(); ++second)
    if (clean[second].starts_with("G0 C") && ++seen == 2) break;
  ASSERT_LT(second + 2, clean.size());
  ASSERT_TRUE(clean[second + 1].starts_with("G0 X")) << clean[second + 1];
  ASSERT_TRUE(clean[second + 2].starts_with("G0 Z")) << clean[second + 2];
  auto lines = clean;
  lines[second] += clean[second + 1].substr(2);
  refused("rotary_and_xy", lines, second);
  lines = clean;
  lines[second + 1] += clean[second + 2].substr(2);
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(second) + 2);
  refused("xy_and_z", lines, second + 1);
  lines = clean;
  std::size_t last = lines.size();
  while (last-- > 0 && !lines[last].starts_with("G53 G0 Z")) {}
  lines[last] += " Y0";
  refused("behind_the_last_tooth", lines, last);
}

// What stands between the operations and behind the last tooth is proven too: a dive in machine
// coordinates through the gear, an operation that the job does not have.
TEST_F(BevelCommand, MovesBesideTheTeethAreProven) {
  const auto clean = program();
  std::vector<std::size_t> retracts;
  for (std::size_t i = 0; i < clean.size(); ++i)
    if (std::regex_search(clean[i], std::regex("^(N[0-9]+ )?G53 G0 Z"))) retracts.push_back(i);
  ASSERT_EQ(retracts.size(), 4u) << "ahead of and behind the teeth of both operations";
  for (const std::size_t at : {retracts[1], retracts[3]}) {
    auto lines = clean;
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), {"G53 G0 Y0", "G53 G0 Z-40"});
    const auto report = check("dive", lines, 1);
    bool named = false;
    for (const auto& reason : report["reasons"]) {
      const auto text = reason.get<std::string>();
      named = named || (text.starts_with("a rapid passes through the blank") &&
                        text.find("line " + std::to_string(at + 2) + ",") != std::string::npos);
    }
    EXPECT_TRUE(named) << at << " " << report["reasons"];
  }
  auto lines = clean;
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(retracts[3]) + 1, "(OP 7 finger_finishing)");
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(retracts[3]) + 2, clean[retracts[3]]);
  write_file(*dir_ / "op.ngc", text_of(lines));
  const Finished unknown = run_program({"check", kBevelTrunnion, *dir_ / "op.ngc", "--out", *dir_ / "op"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_NE(unknown.err.find("operation 7: the job has the operations 0 to 1"), std::string::npos) << unknown.err;
}

// The same proof on any number of threads: of the program as it is, and where teeth are written out.
TEST_F(BevelCommand, OneAndTwoThreadsSayTheSame) {
  const auto report_on = [](const std::string& job, const std::string& name, const char* threads) {
    const Finished done = run_program({"run", job, "--out", *dir_ / name, "--threads", threads, "--quiet"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    auto report = nlohmann::json::parse(file_text(*dir_ / (name + "/report.json")), nullptr, false);
    report.erase("stages");
    return report;
  };
  write_file(*dir_ / "off.toml", off_the_axis());
  for (const std::string& job : {kBevelTrunnion, *dir_ / "off.toml"}) {
    EXPECT_EQ(report_on(job, "one", "1"), report_on(job, "two", "2")) << job;
    for (const char* file : {"program.ngc", "tooth.vtp", "setup.html"})
      EXPECT_EQ(file_text(*dir_ / (std::string("one/") + file)), file_text(*dir_ / (std::string("two/") + file)))
          << job << " " << file;
    EXPECT_NE(file_text(*dir_ / "one/setup.html").find("<td>bevel gear, z "), std::string::npos) << job;
  }
}

// Off the axis of the rotary every tooth is written out. Those that are the first one again are not proven again; a
// fault in one tooth is found there.
TEST_F(BevelCommand, TeethWrittenOutAreCompared) {
  const std::string job = *dir_ / "written.toml";
  write_file(job, off_the_axis());
  ASSERT_EQ(run_program({"run", job, "--out", *dir_ / "written", "--quiet"}).exit_code, 0);
  const auto checked = [&](const std::string& text, const std::string& name, int exit_code) {
    write_file(*dir_ / (name + ".ngc"), text);
    const Finished done = run_program({"check", job, *dir_ / (name + ".ngc"), "--out", *dir_ / name, "--quiet"});
    EXPECT_EQ(done.exit_code, exit_code) << name << done.err;
    return nlohmann::json::parse(file_text(*dir_ / (name + "/report.json")), nullptr, false);
  };
  auto lines = lines_of(file_text(*dir_ / "written/program.ngc"));
  const auto compared = checked(text_of(lines), "compared", 0);
  EXPECT_TRUE(compared["stages"].contains("compare the teeth"));
  EXPECT_EQ(compared["deepest"]["tooth"], 0) << "the first tooth stands for all";
  EXPECT_EQ(compared["tilt"]["simultaneous_axes"], 4) << "of all teeth: X Y Z C";

  const std::size_t finishing = line_with(lines, "(OP 1");
  std::size_t at = finishing;
  while (at < lines.size() && lines[at] != "(TOOTH 5)") ++at;
  const std::regex word("C([-+]?[0-9.]+)");
  std::smatch m;
  int seen = 0;
  for (; at < lines.size(); ++at)
    if (!lines[at].starts_with("G0") && std::regex_search(lines[at], m, word) && ++seen == 25) break;
  ASSERT_LT(at, lines.size());
  bool gouge = false;
  for (const double turn : {0.05, -0.05}) {
    auto changed = lines;
    char c[64];
    std::snprintf(c, sizeof c, "C%.5f", std::stod(m[1].str()) + turn);
    changed[at] = m.prefix().str() + c + m.suffix().str();
    const auto report = checked(text_of(changed), turn > 0 ? "tooth_plus" : "tooth_minus", 1);
    if (report["gouge_um"]["bound"].get<double>() < 5) continue;
    gouge = true;
    const auto& place = report["worst_places"][0];
    EXPECT_EQ(place["tooth"], 5);
    EXPECT_LE(std::abs(place["line"].get<int>() - static_cast<int>(at) - 1), 1);
  }
  EXPECT_TRUE(gouge);
}

// The wheel that belongs to the pinion of the trunnion sample, on a machine with words of three decimals and another
// control.
TEST(BevelMate, RunsOnTheT600SAndIsCheckedThere) {
  const TestDir dir;
  std::string job = file_text(kBevelTrunnion);
  job = replaced(job, "teeth = 18\nmate_teeth = 27", "teeth = 27\nmate_teeth = 18");
  job = replaced(job, "hand = \"right\"", "hand = \"left\"");
  job = replaced(job, "tip_radius = 0.12 ", "tip_radius = 0.07 ");
  job = replaced(job, "file = \"xyzac_trt.toml\"", "file = \"t600s.toml\"");
  job = replaced(job, "origin = [0.0, 0.0, 20.0]", "origin = [0.0, 0.0, -265.0]");
  job = replaced(job, "work_offset_at = [0.0, 0.0, 20.0]", "work_offset_at = [0.0, 0.0, -285.0]");
  write_file(dir / "mate.toml", job);
  const Finished run = run_program({"run", dir / "mate.toml", "--out", dir / "run"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(file_text(dir / "run/report.json"));
  EXPECT_TRUE(report["verified"].get<bool>());
  EXPECT_LE(report["gouge_um"]["bound"].get<double>(), 2.0);
  EXPECT_EQ(report["tilt"]["simultaneous_axes"], 2);
  EXPECT_LE(report["ridge_mm"]["reached"].get<double>(), 0.1);
  for (const auto& [source, entry] : report["ledger"].items())
    EXPECT_LE(entry["measured"].get<double>(), entry["predicted"].get<double>()) << source;
  // The ridge is a result: it stands before the times.
  ASSERT_NE(run.out.find("highest ridge"), std::string::npos);
  EXPECT_LT(run.out.find("highest ridge"), run.out.find("cutting time"));
  const Finished check =
      run_program({"check", dir / "mate.toml", dir / "run/program.nc", "--out", dir / "check", "--quiet"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

}  // namespace
}  // namespace toothpath::test
