// Runs of jobs with line milling that succeed: mills that only rough, regions with cusps of their own.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/app/line_job.h"
#include "tests/app/report.h"

namespace toothpath::test {
namespace {

std::string small_ball(const std::string& lines) { return operation("finishing", 2, lines); }

// Flat and bull nose mills rough; a small ball finishes.
TEST(LineRuns, FlatAndBullNoseRough) {
  for (const bool flat : {true, false}) {
    const TestDir dir;
    std::string gear = kLineGear;
    if (flat) {
      gear = replaced(gear, "\"bull_nose_end_mill\"", "\"flat_end_mill\"");
      gear = replaced(gear, "corner_radius = 0.2\n", "");
    }
    const auto run = run_line_job(dir, gear + roughing(3) + small_ball("scallop = 0.02\nchord_tolerance = 0.002"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(report_in(dir / "out")["verified"].get<bool>());
    EXPECT_EQ(report_in(dir / "out")["operations"][0]["tool"], 3);
    EXPECT_NE(file_text(dir / "out/program.ngc").find(flat ? "FLAT END MILL D1" : "BULL NOSE END MILL D1 R0.2"),
              std::string::npos);
  }
}

/// The largest cusp of a flank and of the rest that a report tells, um.
nlohmann::json cusps_of(const TestDir& dir) { return report_in(dir / "out")["scallop_um"]; }

// Flanks by one ball, fillet and root by another, each with its own cusps; both are held on the cut surface.
TEST(LineRuns, RegionsHaveTheirOwnCusps) {
  const std::string others =
      operation("finishing", 1, "regions = [\"fillet\", \"root\"]\nscallop = 0.012\nchord_tolerance = 0.001");
  const auto job = [&](double flank) {
    return kLineGear + roughing(3) +
           small_ball(fmt::format("regions = [\"flank\"]\nscallop = {}\nchord_tolerance = 0.001", flank)) + others;
  };
  const TestDir fine, coarse;
  for (const auto& [dir, flank] : {std::pair{&fine, 0.004}, {&coarse, 0.012}}) {
    const auto run = run_line_job(*dir, job(flank));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto cusps = cusps_of(*dir);
    std::printf("asked %.1f um: %s\n", 1e3 * flank, cusps.dump().c_str());
    EXPECT_LE(cusps["reached_max"].get<double>(), 1e3 * flank * 1.05);
    EXPECT_GT(cusps["reached_max"].get<double>(), 0.3 * 1e3 * flank);  // and not by cutting finer than asked
    EXPECT_LE(cusps["fillet_max"].get<double>(), 12 * 1.05);
  }
  EXPECT_LT(cusps_of(fine)["reached_max"].get<double>(), 0.6 * cusps_of(coarse)["reached_max"].get<double>());
}

// The whole height of a flank of module 2 and 3 in one strip.
TEST(LineRuns, OffsetAndSpurSamplesInOneStrip) {
  for (const char* name : {"offset_line", "spur_line"}) {
    const TestDir dir;
    const auto run =
        run_program({"run", std::string(TOOTHPATH_SOURCE_DIR) + "/samples/" + name + ".toml", "--out", dir / "out"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto report = report_in(dir / "out");
    EXPECT_TRUE(report["verified"].get<bool>());
    const double left = report["left_um"]["flank"].get<double>();
    std::printf("%s: %.2f um left on the flanks, %.1f h\n", name, left, report["total_minutes"].get<double>() / 60);
    EXPECT_LE(left, 5.0);
    double misfit = 0;  // of the last line milling, which finishes: the ledger speaks of the same number
    for (const auto& operation : report["operations"]) {
      EXPECT_EQ(operation.value("strips", 1), 1);
      misfit = operation.value("misfit_um", misfit);
    }
    // What each way takes, of every flank.
    int told = 0;
    for (const auto& operation : report["operations"])
      for (const auto& way : operation.value("ways", nlohmann::json::array())) {
        ++told;
        EXPECT_EQ(way["taken"], "side");
        ASSERT_EQ(way["tried"].size(), 1u);
        EXPECT_EQ(way["tried"][0]["strips"], 1);
        EXPECT_GT(way["ball_passes"].get<int>(), 10);
        EXPECT_GT(way["ball_minutes"].get<double>(), 5 * way["side_minutes"].get<double>());
      }
    EXPECT_EQ(told, 2 * 3) << name;
    EXPECT_NE(file_text(dir / "out/report.html").find("Side or ball: what each way takes"), std::string::npos);
    const auto& entry = report["ledger"]["line misfit"];
    EXPECT_GT(misfit, 0) << name;
    EXPECT_NEAR(misfit, entry["measured"].get<double>(), 1e-9) << name;
    EXPECT_LE(misfit, entry["predicted"].get<double>()) << name;
  }
}

// Where the job leaves it open, flanks are finished by the side of the mill or by its ball end: by the quicker one of
// those that hold `left`. The report says what both take, and `check` knows which was taken.
TEST(LineRuns, TheQuickerWayThatHoldsLeftIsTaken) {
  struct Case {
    const char* keys;
    const char* taken;
    bool refused;  ///< the other one
  };
  for (const Case& c : {Case{"left = 0.005", "side", false},
                        Case{"left = 0.001\nstrips = 1", "ball", true},  // the side leaves 3 um in one strip
                        Case{"left = 0.2\nstrips = 7", "ball", false}}) {
    const TestDir dir;
    const std::string job =
        kLineGear +
        operation("line_milling", 1, fmt::format("{}\nstrategy = \"best\"\nchord_tolerance = 0.001", c.keys)) +
        kFilletAndRoot;
    const auto run = run_line_job(dir, job);
    ASSERT_EQ(run.exit_code, 0) << c.keys << "\n" << run.err;
    const auto report = report_in(dir / "out");
    EXPECT_TRUE(report["verified"].get<bool>());
    const auto& operation = report["operations"][0];
    EXPECT_EQ(operation["type"], std::string(c.taken) == "ball" ? "finishing" : "line_milling") << c.keys;
    ASSERT_EQ(operation["ways"].size(), 2u);
    for (const auto& way : operation["ways"]) {
      EXPECT_EQ(way["taken"], c.taken) << c.keys;
      EXPECT_EQ(way.contains("refused"), c.refused) << way.dump();
      if (c.refused) {
        EXPECT_NE(way["refused"].get<std::string>().find("cannot be met"), std::string::npos) << way.dump();
        EXPECT_FALSE(way.contains("side_minutes"));
        continue;
      }
      const bool side_is_quicker = way["side_minutes"].get<double>() < way["ball_minutes"].get<double>();
      EXPECT_EQ(side_is_quicker, std::string(c.taken) == "side") << way.dump();
    }
    const auto checked = run_program({"check", dir / "job.toml", dir / "out/program.ngc", "--out", dir / "checked"});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
  }
}

// Where the job states a chip load, roughing is fed by the chip that is measured on the stock: quicker, and no chip is
// larger.
TEST(LineRuns, RoughingIsFedByItsChip) {
  const std::string plain = operation("roughing", 2, "step_down = 0.5\nstep_over = 0.3\nallowance = 0.1"),
                    finish = small_ball("scallop = 0.03\nchord_tolerance = 0.004");
  const auto minutes = [&](const std::string& rough, nlohmann::json* engagement) {
    const TestDir dir;
    const auto run = run_line_job(dir, kLineGear + rough + finish);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto report = report_in(dir / "out");
    if (report.contains("engagement")) *engagement = report["engagement"];
    EXPECT_EQ(file_text(dir / "out/report.html").find("Teeth in the material") != std::string::npos,
              report.contains("engagement"));
    return report["operations"][0]["cutting_minutes"].get<double>();
  };
  nlohmann::json none, found;
  const double before = minutes(plain, &none), after = minutes(plain + "chip_load = 0.012\n", &found);
  EXPECT_TRUE(none.is_null());
  ASSERT_EQ(found.size(), 1u);
  std::printf("%.2f min by feed, %.2f min by chip: %s\n", before, after, found.dump().c_str());
  EXPECT_LT(after, 0.9 * before);
  EXPECT_LE(found[0]["chip_um"].get<double>(), 12 + 1e-6);
  EXPECT_LE(found[0]["most_feed"].get<double>(), 3 * 300 + 1e-6);
}

// The same as a table of one operation.
TEST(LineRuns, TableOfCusps) {
  const TestDir dir;
  const auto run = run_line_job(
      dir, kLineGear + roughing(3) +
               operation("finishing", 1,
                         "scallop = {flank = 0.004, fillet = 0.012, root = 0.012}\nchord_tolerance = 0.001"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto cusps = cusps_of(dir);
  std::printf("table: %s\n", cusps.dump().c_str());
  EXPECT_LE(cusps["reached_max"].get<double>(), 4 * 1.05);
  EXPECT_LE(cusps["fillet_max"].get<double>(), 12 * 1.05);
  EXPECT_GT(cusps["fillet_max"].get<double>(), 4);
}

/// The report but for the run times.
nlohmann::json findings_in(const TestDir& dir, const std::string& out) {
  auto report = nlohmann::json::parse(file_text(dir / (out + "/report.json")));
  report.erase("stages");
  return report;
}

/// Where the part stands off the rotary axis, and words are rounded to a micrometre, no tooth is a copy of the first.
std::string off_the_axis(const TestDir& dir, std::string job) {
  write_file(dir / "machine.toml", changed_machine("", "", "\n[post]\nlinear_decimals = 3\nrotary_decimals = 4\n"));
  job = replaced(job, "\"xyzac_large.toml\"", "\"machine.toml\"");
  return replaced(job, "origin = [3.0, -2.0, 120.0]", "origin = [14.0, -9.0, 120.0]");
}

// Flanks by the line on the rotary axis, by a ball off it: threads change nothing.
TEST(LineRuns, OneAndTwoThreadsGiveTheSameProgram) {
  const TestDir dir;
  const std::string job = kLineGear + operation("line_milling", 1, "left = 0.005") + kFilletAndRoot;
  write_file(dir / "on.toml", job);
  write_file(dir / "off.toml", off_the_axis(dir, kLineGear + small_ball("scallop = 0.02\nchord_tolerance = 0.002")));
  for (const std::string place : {"on", "off"}) {
    for (const std::string threads : {"1", "2"}) {
      const auto run =
          run_program({"run", dir / (place + ".toml"), "--out", dir / (place + threads), "--threads", threads});
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    EXPECT_EQ(file_text(dir / (place + "1/program.ngc")), file_text(dir / (place + "2/program.ngc"))) << place;
    EXPECT_EQ(findings_in(dir, place + "1"), findings_in(dir, place + "2")) << place;
  }
}

/// The program of `job` with a Z of its last tooth 0.1 mm lower, and the line of that word.
std::pair<std::string, int> with_a_deep_cut(std::string text) {
  const std::size_t tooth = text.rfind("(TOOTH "), feed = text.find("G1 ", tooth),
                    at = text.find(" Z", feed + (text.find("G94", feed) - feed) / 2);
  const std::size_t end = text.find_first_of(" \n", at + 1);
  const double z = std::stod(text.substr(at + 2, end - at - 2));
  text.replace(at + 2, end - at - 2, fmt::format("{:.3f}", z - 0.1));
  return {text, int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n')) + 1};
}

// No tooth is held while the program is proven, and none is left out: a block of the last one that cuts too deep is
// found, told with its line.
TEST(LineRuns, AFaultInTheLastToothOffTheAxisIsFound) {
  const TestDir dir;
  write_file(dir / "off.toml", off_the_axis(dir, kLineGear + small_ball("scallop = 0.02\nchord_tolerance = 0.002")));
  ASSERT_EQ(run_program({"run", dir / "off.toml", "--out", dir / "made"}).exit_code, 0);
  const auto [text, line] = with_a_deep_cut(file_text(dir / "made/program.ngc"));
  write_file(dir / "deep.ngc", text);
  for (const std::string threads : {"1", "2"}) {
    const auto run = run_program(
        {"check", dir / "off.toml", dir / "deep.ngc", "--out", dir / ("deep" + threads), "--threads", threads});
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_NE(run.err.find("gouge: "), std::string::npos) << run.err;
    const auto worst = findings_in(dir, "deep" + threads)["worst_places"];
    ASSERT_FALSE(worst.empty());
    EXPECT_NEAR(worst[0]["line"].get<int>(), line, 1);
  }
  EXPECT_EQ(findings_in(dir, "deep1"), findings_in(dir, "deep2"));
  write_file(dir / "other.ngc", replaced(file_text(dir / "made/program.ngc"), "(OP 0 ", "(OP 7 "));
  const auto refused = run_program({"check", dir / "off.toml", dir / "other.ngc", "--out", dir / "other"});
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find("operation 7: the job has the operations 0 to 0"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace toothpath::test
