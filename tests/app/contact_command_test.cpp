// `contact`, `compare` and `study dhfg`, run as a user would.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/app/contact_run.h"

namespace toothpath::test {
namespace {

/// The badge of the page says what its patterns do.
void expect_verdict(const std::string& page, const Json& report) {
  bool off = true;
  for (const Json& flank : report.at("flanks"))
    for (const Json& zone : flank.at("zones"))
      off = off && zone.at("pattern").at("words").get<std::string>().find("runs out at") == std::string::npos;
  EXPECT_EQ(page.find("verdict good") != std::string::npos, off);
  EXPECT_EQ(page.find("contact inside the flanks</div>") != std::string::npos, off);
  EXPECT_EQ(page.find("pattern runs out at: ") != std::string::npos, !off);
}

/// The offset sample with a pinion of two teeth less: the printed path, no transmission error, a pattern that keeps off
/// the outer end.
TEST(ContactCommand, OffsetGear) {
  const TestDir dir;
  const std::string out = dir / "out";
  const Json report = contact_of({"contact", kSamples + "/offset_shaped.toml", "--pinion-teeth", "23", "--out", out});
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"contact.csv", "contact.html", "contact.json", "ease_off.csv",
                                                     "transmission.csv"}));
  EXPECT_EQ(report, Json::parse(file_text(out + "/contact.json")));
  ASSERT_EQ(report.at("flanks").size(), 2u);
  const double tip[] = {134.031, 132.173}, pinion_tip[] = {132.266, 133.759};
  for (const int k : {0, 1}) {
    const Json& flank = report.at("flanks")[std::size_t(k)];
    EXPECT_EQ(flank.at("side"), k == 0 ? 1 : -1);
    EXPECT_EQ(flank.at("contact"), "point");
    EXPECT_LT(flank.at("transmission_error").at("range_urad").get<double>(), 1e-6);
    const Json& zone = flank.at("zones")[0];
    EXPECT_NEAR(zone.at("path").at("from").at("r").get<double>(), tip[k], 6e-4);
    EXPECT_NEAR(zone.at("path").at("to").at("r").get<double>(), pinion_tip[k], 6e-4);
    EXPECT_NEAR(zone.at("path").at("B_deg").get<double>(), k == 0 ? 20 : -20, 1e-9);
    EXPECT_NEAR(flank.at("contact_ratio").get<double>(), zone.at("path").at("ratio").get<double>(), 0.05);
    const double share = zone.at("pattern").at("share");
    EXPECT_GT(share, 0.02);
    EXPECT_LT(share, 0.9);
    EXPECT_FALSE(zone.at("pattern").at("at_outer_end").get<bool>());
  }
  // The drawing has the pattern of both members and both sides.
  const std::string page = file_text(out + "/contact.html");
  for (const char* words :
       {"Gear: flank +1, exact", "Pinion: flank +1, exact", "Gear: flank -1, exact", "Pinion: flank -1, exact"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  expect_verdict(page, report);
}

/// Options stand above the keys of [contact]; a misalignment moves the path; the pinion as shaper marks the whole flank
/// it reaches.
TEST(ContactCommand, KeysAndOptions) {
  const TestDir dir;
  const std::string job =
      changed_sample(dir, "offset_shaped.toml", "[machine]",
                     "[contact]\npinion_teeth = 23\noffset_error = 0.1\ncompound = 0.01\n\n[machine]");
  const Json keys = contact_of({"contact", job, "--out", dir / "a"});
  EXPECT_EQ(keys.at("pinion_teeth"), 23);
  EXPECT_NEAR(keys.at("compound_um").get<double>(), 10, 1e-12);
  EXPECT_NEAR(keys.at("flanks")[0].at("zones")[0].at("path").at("B_deg").get<double>(), 21.996, 6e-4);
  const Json options = contact_of(
      {"contact", job, "--pinion-teeth", "25", "--offset-error", "0", "--compound", "4", "--out", dir / "b"});
  EXPECT_EQ(options.at("pinion_teeth"), 25);
  for (const Json& flank : options.at("flanks")) {
    EXPECT_EQ(flank.at("contact"), "line");
    EXPECT_LT(flank.at("transmission_error").at("range_urad").get<double>(), 1e-6);
    EXPECT_GT(flank.at("zones")[0].at("pattern").at("share").get<double>(), 0.8);
  }
}

/// The ease-off in the report, as CSV, on the screen and drawn; the three tell one map, and it is that of the keys.
TEST(ContactCommand, EaseOff) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto run = run_program({"contact", kSamples + "/spur_modified.toml", "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json flank = Json::parse(file_text(out + "/contact.json")).at("flanks")[1];  // -1: without the helix slope
  const Json& map = flank.at("ease_off");
  const Json& grid = map.at("zones")[0];
  ASSERT_EQ(grid.at("um").size(), 11u);
  ASSERT_EQ(grid.at("r").size(), 13u);
  // At the gear's tip its relief of 12 um, at the ends the crowning of 8 um on top of it.
  const Json& tip = grid.at("um")[10];
  // A place of the modified tip has its plain one some micrometres above the tip, where the relief goes on.
  EXPECT_NEAR(tip[6].get<double>(), 12, 0.2);
  EXPECT_NEAR(tip[12].get<double>(), 20, 0.2);
  EXPECT_NEAR(map.at("greatest").at("um").get<double>(), tip[12].get<double>(), 1e-3);
  EXPECT_NEAR(map.at("least").at("um").get<double>(), 0, 1e-12);
  // The same places in ease_off.csv.
  std::istringstream csv(file_text(out + "/ease_off.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "surface,flank,zone,row,column,r,z,ease_off_um,phi_2_deg,pinion_radius,pinion_Z");
  int found = 0, lines = 0;
  while (std::getline(csv, line)) {
    ++lines;
    if (!line.starts_with("exact,-1,0,40,24,")) continue;
    ++found;
    std::istringstream cells(line);
    std::string cell;
    for (int k = 0; k < 8; ++k) std::getline(cells, cell, ',');
    EXPECT_NEAR(std::stod(cell), tip[6].get<double>(), 1e-9) << line;
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(lines, 2 * 41 * 49);
  EXPECT_NE(run.out.find("ease-off: up to 20."), std::string::npos) << run.out;
  for (const char* words : {"Ease-off: flank -1, exact", "Motion curves of the pairs", "Misaligned"})
    EXPECT_NE(file_text(out + "/contact.html").find(words), std::string::npos) << words;
  // A pinion that is the plain gear's shaper has none.
  const auto plain = run_program({"contact", kSamples + "/spur_quick.toml", "--out", dir / "plain"});
  EXPECT_NE(plain.out.find("ease-off: none, the flanks are conjugate"), std::string::npos) << plain.out;
}

/// inspection.csv of a job with the deviation of a crowning: all flanks lower by so much at both ends of the face.
void write_crowned(const TestDir& dir, const std::string& job, double inner, double outer, double amount_um) {
  ASSERT_EQ(run_program({"surface", job, "--out", dir / "surface"}).exit_code, 0);
  std::istringstream in(file_text(dir / "surface/inspection.csv"));
  std::string line, out;
  std::getline(in, line);
  out = line + ",deviation_um\n";
  while (std::getline(in, line)) {
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    const double x = 2 * (std::hypot(values.at(4), values.at(5)) - inner) / (outer - inner) - 1;
    out += line + "," + std::to_string(-amount_um * x * x) + "\n";
  }
  write_file(dir / "measured.csv", out);
}

/// A crowning that was measured is rolled and loaded like one that the drawing asks for.
TEST(ContactCommand, AMeasuredCrowningRollsLikeTheDrawnOne) {
  const TestDir dir;
  const std::string plain = changed_sample(dir, "spur_quick.toml", "[machine]",
                                           "[contact]\npinion_teeth = 20\nangle_error = 0.02\n\n[machine]");
  write_crowned(dir, plain, 60, 65, 8);
  const Json measured = contact_of(
      {"contact", plain, "--measured", dir / "measured.csv", "--torque", "50", "--positions", "2", "--out", dir / "a"});
  EXPECT_EQ(measured.at("cut_surface"), "measured");
  const TestDir other;
  const std::string crowned = changed_sample(
      other, "spur_quick.toml", "[machine]",
      "[[gear.modification]]\nkind = \"lead_crowning\"\namount = 0.008\n\n[contact]\npinion_teeth = 20\nangle_error "
      "= 0.02\n\n[machine]");
  const Json drawn = contact_of({"contact", crowned, "--torque", "50", "--positions", "2", "--out", dir / "b"});
  const auto flank = [](const Json& report, const char* surface, int side) -> const Json& {
    for (const Json& f : report.at("flanks"))
      if (f.at("surface") == surface && f.at("side") == side) return f;
    throw std::invalid_argument("no such flank");
  };
  for (const int side : {1, -1}) {
    const Json &m = flank(measured, "cut", side), &d = flank(drawn, "exact", side);
    const double error = d.at("transmission_error").at("range_urad").get<double>();
    EXPECT_GT(error, 1) << "a crowned pair that stands askew has a transmission error";
    EXPECT_NEAR(m.at("transmission_error").at("range_urad").get<double>(), error, 0.05 * error);
    const Json &lm = flank(measured.at("loaded"), "cut", side), &ld = flank(drawn.at("loaded"), "exact", side);
    EXPECT_EQ(lm.at("name"), side > 0 ? "flank +1, measured" : "flank -1, measured");
    const double approach = ld.at("approach_um").at("mean").get<double>();
    EXPECT_NEAR(lm.at("approach_um").at("mean").get<double>(), approach, 0.03 * approach);
  }
  const auto both = run_program({"contact", plain, "--as-cut", "--measured", dir / "measured.csv", "--out", dir / "c"});
  EXPECT_EQ(both.exit_code, 2);
  const auto bevel = run_program({"contact", kSamples + "/bevel_pinion.toml", "--mate", kSamples + "/bevel_wheel.toml",
                                  "--measured", dir / "measured.csv", "--out", dir / "d"});
  EXPECT_EQ(bevel.exit_code, 3);
  EXPECT_NE(bevel.err.find("measured.csv:2:3: error: flank = \"1\" must be L or U"), std::string::npos) << bevel.err;
}

/// Two jobs, two gears: the double helical face gear with its milled pinion, whichever of the two is asked, and two
/// spur gears at any distance. One writer for all pairs.
TEST(ContactCommand, TwoJobsRoll) {
  const TestDir dir;
  const std::string face = kSamples + "/dhfg_paper.toml", pinion = kSamples + "/cylindrical_pinion.toml",
                    spur = kSamples + "/cylindrical_spur.toml";
  const Json report = contact_of({"contact", pinion, "--mate", face, "--out", dir / "face"});
  EXPECT_EQ(names_in(dir / "face"), (std::vector<std::string>{"contact.csv", "contact.html", "contact.json",
                                                              "ease_off.csv", "transmission.csv"}));
  EXPECT_EQ(report.at("mate"), face);
  EXPECT_EQ(report.at("gear_teeth"), 180);
  for (const Json& flank : report.at("flanks")) {
    EXPECT_EQ(flank.at("contact"), "conjugate");
    EXPECT_LT(flank.at("transmission_error").at("range_um").get<double>(), 1e-5);
    EXPECT_EQ(flank.at("zones").size(), 2u);
  }
  std::vector<double> ratios;
  for (const std::string distance : {"73.2", "73.8"}) {
    const Json pair = contact_of({"contact", spur, "--mate", spur, "--axis-distance", distance, "--out", dir / "spur"});
    EXPECT_NEAR(pair.at("shafts").at("distance_mm").get<double>(), std::stod(distance), 1e-12);
    EXPECT_LT(pair.at("flanks")[0].at("transmission_error").at("range_urad").get<double>(), 1e-5);
    ratios.push_back(pair.at("flanks")[0].at("contact_ratio").get<double>());
  }
  EXPECT_GT(ratios[0], ratios[1] + 0.05);
}

/// Measured flanks that are too thick by the same everywhere are as conjugate as drawn ones, and turn the pair.
TEST(ContactCommand, AMeasuredFlankRollsWithTheMateOfAnotherJob) {
  const TestDir dir;
  const std::string spur = kSamples + "/cylindrical_spur.toml";
  ASSERT_EQ(run_program({"surface", spur, "--out", dir / "surface"}).exit_code, 0);
  std::istringstream drawn(file_text(dir / "surface/inspection.csv"));
  std::string line, text;
  while (std::getline(drawn, line)) text += line + (text.empty() ? ",deviation_um\n" : ",10\n");
  write_file(dir / "measured.csv", text);
  const Json report =
      contact_of({"contact", spur, "--mate", spur, "--measured", dir / "measured.csv", "--out", dir / "out"});
  EXPECT_EQ(report.at("cut_surface"), "measured");
  ASSERT_EQ(report.at("flanks").size(), 4u);
  const auto error = [&](std::size_t k, const char* what) {
    return report.at("flanks")[k].at("transmission_error").at(what).get<double>();
  };
  EXPECT_LT(error(2, "range_urad"), 1e-3);
  EXPECT_NEAR(error(0, "mean_urad") - error(2, "mean_urad"), 1e4 / (36 * std::cos(20 * std::acos(-1) / 180)), 1e-2);
}

/// An equal-base-circle gear rolls by the rules of its pair, and the same mate given by its points as any two gears
/// do: both ways find one transmission error on wall U. The grid of points keeps off the edges, where wall L bears.
TEST(ContactCommand, AnEqualBaseCircleGearRollsWithItsMateByPoints) {
  const TestDir dir;
  const std::string pinion = kSamples + "/bevel_ball.toml";
  write_file(dir / "wheel.toml",
             replaced(replaced(file_text(pinion), "teeth = 18\nmate_teeth = 37", "teeth = 37\nmate_teeth = 18"),
                      "hand = \"right\"", "hand = \"left\""));
  ASSERT_EQ(run_program({"surface", dir / "wheel.toml", "--out", dir / "surface"}).exit_code, 0);
  std::string points = file_text(dir / "surface/inspection.csv");
  for (const auto& [wall, flank] : {std::pair("\n0,L,", "\n0,1,"), {"\n0,U,", "\n0,-1,"}})
    for (std::size_t at; (at = points.find(wall)) != std::string::npos;)
      points.replace(at, std::string_view(wall).size(), flank);
  write_file(dir / "points.csv", points);
  ASSERT_EQ(run_program({"new", "--points", dir / "points.csv", "--teeth", "37", "--machine", "xyzac_large", "-o",
                         dir / "grid.toml"})
                .exit_code,
            0);
  const Json own = contact_of({"contact", pinion, "--mate", dir / "wheel.toml", "--out", dir / "own"}),
             any = contact_of(
                 {"contact", pinion, "--mate", dir / "grid.toml", "--shaft-angle", "90", "--out", dir / "any"});
  const double of_pinion = own.at("walls")[1].at("transmission_error_urad").get<double>(),
               of_wheel = any.at("flanks")[1].at("transmission_error").at("range_urad").get<double>();
  EXPECT_NEAR(of_wheel, of_pinion * 18 / 37, 0.05 * of_wheel);
  // Measured walls that are too thick by 10 um turn it by that over the arm of the normal about the axis, which lies
  // between its least and its largest on the wall.
  ASSERT_EQ(run_program({"surface", pinion, "--out", dir / "drawn"}).exit_code, 0);
  std::istringstream drawn(file_text(dir / "drawn/inspection.csv"));
  std::string line, text;
  double least = INFINITY, most = 0;
  while (std::getline(drawn, line)) {
    text += line + (text.empty() ? ",deviation_um\n" : ",10\n");
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string zone, wall, row, column;
    double x = 0, y = 0, z = 0, i = 0, j = 0;
    if (!(words >> zone >> wall >> row >> column >> x >> y >> z >> i >> j)) continue;
    least = std::min(least, std::abs(x * j - y * i));
    most = std::max(most, std::abs(x * j - y * i));
  }
  write_file(dir / "measured.csv", text);
  const Json measured = contact_of({"contact", pinion, "--mate", dir / "grid.toml", "--shaft-angle", "90", "--measured",
                                    dir / "measured.csv", "--out", dir / "measured"});
  EXPECT_EQ(measured.at("cut_surface"), "measured");
  ASSERT_EQ(measured.at("flanks").size(), 4u);
  for (const std::size_t k : {0U, 1U}) {
    const auto mean = [&](std::size_t flank) {
      return measured.at("flanks")[flank].at("transmission_error").at("mean_urad").get<double>();
    };
    const double turned = std::abs(mean(k) - mean(k + 2));
    EXPECT_GT(turned, 0.98e4 / most) << k;
    EXPECT_LT(turned, 1.02e4 / least) << k;
  }
}

/// What two jobs do not say, and what such pairs do not have, with the place.
TEST(ContactCommand, TwoJobsThatDoNotRoll) {
  const TestDir dir;
  const std::string spur = kSamples + "/cylindrical_spur.toml", cone = kSamples + "/straight_bevel.toml",
                    grid = kSamples + "/flank_grid_spur.toml", spiral = kSamples + "/spiral_bevel.toml";
  const std::tuple<int, std::vector<std::string>, std::string> refused[] = {
      {3, {spur}, "rolls with a mate that has a job of its own: --mate JOB is needed"},
      {2, {spur, "--axis-distance", "72"}, "--axis-distance belongs to --mate"},
      {3, {spur, "--mate", spur, "--torque", "100"}, "there is no elastic model of such pairs"},
      {3, {spur, "--mate", spur, "--optimise"}, "--optimise knows face gears"},
      {3, {spur, "--mate", spur, "--pinion-teeth", "20"}, "--pinion-teeth contradicts the mate"},
      {3, {spur, "--mate", spur, "--shaft-angle", "10"}, "on shafts at 0 deg, not 10"},
      {3, {spur, "--mate", spur, "--axis-distance", "200"}, "come to each other in no turn"},
      {3, {spur, "--mate", cone}, "does not run with a"},
      {3, {spiral, "--mate", cone}, "do not roll on each other with"},
      {3, {grid, "--mate", cone}, "--shaft-angle DEG is needed"},
      {3, {spiral, "--mate", spiral}, "add up to 36.86667 deg, the shafts stand at 90 deg"},
      {3, {spiral, "--mate", kSamples + "/bevel_wheel.toml"}, "do not roll on each other with"},
      {3, {kSamples + "/bevel_wheel.toml", "--mate", spur}, "does not run with a"},
      {3,
       {kSamples + "/spur_quick.toml", "--mate", spur},
       "the normal base pitch, 8.85639 mm, is not that of the face gear, 5.90426 mm"},
      {3,
       {kSamples + "/dhfg_paper.toml", "--mate", spur},
       "no zone has a helix_angle of -30 deg, that of zone 0 of the face gear"},
      {3,
       {kSamples + "/dhfg_paper.toml", "--mate", kSamples + "/cylindrical_pinion.toml", "--torque", "100"},
       "leave out --mate, --pinion-teeth 30 is that pinion"},
      {3, {kSamples + "/dhfg_paper.toml", "--mate", cone}, "does not run with a face gear"},
      {3,
       {kSamples + "/dhfg_paper.toml", "--mate", kSamples + "/cylindrical_pinion.toml", "--shaft-angle", "90"},
       "the face gear says them, as shaft_angle and offset"},
      {3,
       {kSamples + "/bevel_wheel.toml", "--mate", kSamples + "/bevel_pinion.toml", "--shaft-angle", "90"},
       "rolls on the shafts that it was made for"}};
  for (const auto& [code, words, said] : refused) {
    std::vector<std::string> arguments = {"contact", "--out", dir / "out"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Finished run = run_program(arguments);
    EXPECT_EQ(run.exit_code, code) << said;
    EXPECT_NE(run.err.find(said), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(".toml:") != std::string::npos, code == 3) << run.err;
  }
}

/// A contact run that fails, however it does, leaves what an earlier one wrote as it was and says so, and nothing
/// half-written; what belongs to others stays.
TEST(ContactCommand, AFailedRunLeavesEverythingAsItWas) {
  const TestDir dir;
  const std::string out = dir / "out", good = kSamples + "/offset_shaped.toml", bevel = kSamples + "/bevel_pinion.toml";
  const std::vector<std::string> pages = {"contact.csv", "contact.html", "contact.json", "ease_off.csv",
                                          "transmission.csv"},
                                 kept = {"my notes.txt", "program.ngc", "report.html"};
  const auto older = [&] {
    std::filesystem::create_directories(out);
    for (const auto& name : pages) write_file(out + "/" + name, "older");
    for (const auto& name : kept) write_file(out + "/" + name, "not of this command");
  };
  std::vector<std::string> all = kept;
  all.insert(all.end(), pages.begin(), pages.end());
  std::sort(all.begin(), all.end());
  const auto expect_as_it_was = [&](const std::string& what) {
    EXPECT_EQ(names_in(out), all) << what;
    for (const auto& name : kept) EXPECT_EQ(file_text(out + "/" + name), "not of this command") << what;
    for (const auto& name : pages) EXPECT_EQ(file_text(out + "/" + name), "older") << what;
  };
  const auto expect_said = [&](const Finished& run) {
    EXPECT_NE(run.err.find(": " + out + " stays as it was: contact.csv of 20"), std::string::npos) << run.err;
  };
  const std::pair<int, std::vector<std::string>> refused[] = {{3, {good, "--pinion-teeth", "26"}},
                                                              {2, {good, "--compound", "1000"}},
                                                              {3, {kBadJobs + "/module_negative.toml"}},
                                                              {4, {dir / "no_such.toml"}},
                                                              {3, {bevel, "--mate", good}}};
  for (const auto& [code, words] : refused) {
    older();
    std::vector<std::string> arguments = {"contact", "--out", out};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Finished run = run_program(arguments);
    EXPECT_EQ(run.exit_code, code) << words.back();
    expect_as_it_was(words.back());
    if (code != 2) expect_said(run);  // a wrong command line is no run
  }
  // The disk is full from the beginning, and at a later file.
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{4000}}) {
    older();
    Launch launch;
    launch.arguments = {"contact", good, "--pinion-teeth", "23", "--out", out, "--quiet"};
    launch.largest_file = bytes;
    const Finished run = run_program(launch);
    EXPECT_EQ(run.exit_code, 4) << bytes;
    expect_as_it_was("files of at most " + std::to_string(bytes) + " bytes");
    if (bytes > 0) expect_said(run);  // else stderr, a file here, takes no byte either
  }
  // Ended by a signal while it computes.
  older();
  Launch launch;
  launch.arguments = {"contact", good, "--pinion-teeth", "23", "--torque", "5", "--positions", "24", "--out", out};
  launch.signal_number = SIGTERM;
  launch.signal_after_ms = 300;
  const Finished run = run_program(launch);
  EXPECT_EQ(run.exit_code, 130);
  expect_as_it_was("signal");
  expect_said(run);
}

TEST(ContactCommand, Refusals) {
  const TestDir dir;
  const auto many =
      run_program({"contact", kSamples + "/offset_shaped.toml", "--pinion-teeth", "26", "--out", dir / "a"});
  EXPECT_EQ(many.exit_code, 3);
  EXPECT_NE(many.err.find("pinion_teeth = 26 exceeds the shaper's 25"), std::string::npos) << many.err;
  EXPECT_EQ(
      run_program({"contact", kSamples + "/offset_shaped.toml", "--compound", "1000", "--out", dir / "b"}).exit_code,
      2);
  const auto mate = run_program({"contact", kSamples + "/bevel_pinion.toml", "--out", dir / "c"});
  EXPECT_EQ(mate.exit_code, 3);
  EXPECT_NE(mate.err.find("--mate JOB names the one that is there"), std::string::npos) << mate.err;
  EXPECT_EQ(
      run_program({"compare", kSamples + "/offset_milled.toml", kSamples + "/offset_milled.toml", "--out", dir / "d"})
          .exit_code,
      3);
  for (const char* name : {"a", "b", "c", "d"}) EXPECT_TRUE(names_in(dir / name).empty()) << name;
}

constexpr const char* kShapingTables = R"([machine]
file = "y514.toml"
accept_assumed = true

[shaping]
cutting_speed = 20.0
speed_basis = "mean"
circular_feed = 0.3
radial_feed = 0.02
over_run = 2.5
offset_reference = "outer_radius"
)";

/// The gear of the quick sample on the gear shaper.
std::string shaped_job(const TestDir& dir, const std::string& name) {
  const std::string milled = file_text(kSamples + "/spur_quick.toml");
  const std::string path = dir / name;
  write_file(path, milled.substr(0, milled.find("[machine]")) + kShapingTables);
  return path;
}

/// Strokes cut a polygon: the ripple of its flanks shows in the mesh, and stays below their deviation.
TEST(ContactCommand, SurfaceOfTheStrokes) {
  const TestDir dir;
  const Json report =
      contact_of({"contact", shaped_job(dir, "shaped.toml"), "--pinion-teeth", "18", "--as-cut", "--out", dir / "out"});
  EXPECT_EQ(report.at("cut_surface"), "shaped");
  ASSERT_EQ(report.at("flanks").size(), 4u);
  for (const std::size_t k : {2u, 3u}) {
    const double um = report.at("flanks")[k].at("transmission_error").at("range_um");
    EXPECT_GT(um, 1e-3);
    EXPECT_LT(um, 20);
  }
}

/// One quick gear by both routes: both deviations are those that the routes' own commands state, their difference is
/// taken place by place.
TEST(CompareCommand, QuickGear) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto done =
      run_program({"compare", shaped_job(dir, "shaped.toml"), kSamples + "/spur_quick.toml", "--out", out, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"compare.csv", "compare.html", "compare.json"}));
  const Json report = Json::parse(done.out).at("report");
  EXPECT_TRUE(report.at("milled").at("verified").get<bool>());
  EXPECT_GT(report.at("shaped").at("minutes").get<double>(), 0);
  EXPECT_GT(report.at("milled").at("minutes").get<double>(), report.at("milled").at("cutting_minutes").get<double>());
  ASSERT_EQ(report.at("flanks").size(), 2u);
  for (const Json& flank : report.at("flanks")) {
    const Json &shaped = flank.at("shaped"), &milled = flank.at("milled"), &difference = flank.at("difference");
    EXPECT_GT(shaped.at("min_um").get<double>(), -0.5);  // strokes never cut into the generated flank
    EXPECT_LT(shaped.at("max_um").get<double>(), 20);
    EXPECT_GT(milled.at("min_um").get<double>(), -2.0);
    EXPECT_LT(milled.at("max_um").get<double>(), 40);
    EXPECT_LE(difference.at("max_um").get<double>(),
              milled.at("max_um").get<double>() - shaped.at("min_um").get<double>() + 1e-9);
    EXPECT_GE(difference.at("min_um").get<double>(),
              milled.at("min_um").get<double>() - shaped.at("max_um").get<double>() - 1e-9);
  }
  // Another gear is refused with key and both values.
  const std::string other = changed_sample(dir, "spur_quick.toml", "teeth = 60", "teeth = 62");
  const auto refused = run_program({"compare", shaped_job(dir, "shaped.toml"), other, "--out", dir / "other"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("teeth = 62 differs from 60"), std::string::npos) << refused.err;
}

/// The levels of the literature without milling: nine rows, balanced axial forces, no transmission error, trends of the
/// overlap.
TEST(DhfgStudy, NineTrials) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto done = run_program({"study", "dhfg", "--quick", "--out", out, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"dhfg.csv", "dhfg.html", "dhfg.json"}));
  const Json report = Json::parse(done.out).at("report");
  ASSERT_EQ(report.at("trials").size(), 9u);
  // Every pair of levels of two factors occurs once.
  std::set<std::pair<int, int>> teeth_ratio, teeth_helix;
  for (const Json& trial : report.at("trials")) {
    const int teeth = trial.at("pinion_teeth"), gear = trial.at("teeth");
    teeth_ratio.insert({teeth, gear / teeth});
    teeth_helix.insert({teeth, int(std::lround(trial.at("helix_deg").get<double>()))});
    EXPECT_EQ(trial.at("refusal"), "") << trial.at("trial");
    EXPECT_GT(trial.at("half_face").get<double>(), 5);
    EXPECT_NEAR(trial.at("axial_N").at("balanced").get<double>(), 0, 1e-6);
    EXPECT_NEAR(trial.at("axial_N").at("held").get<double>() / trial.at("axial_N").at("single_helix").get<double>(),
                0.3, 1e-9);
    EXPECT_LT(trial.at("error_range_urad").get<double>(), 1e-6);
    EXPECT_GE(trial.at("contact_ratio").at("v_teeth").get<double>(),
              trial.at("contact_ratio").at("outer").get<double>() - 1e-12);
    EXPECT_GE(trial.at("pairs")[0].get<int>(), 2);
    // Under load: docs/loaded_contact.md.
    const Json& loaded = trial.at("loaded");
    EXPECT_GT(loaded.at("stiffness_N_mm").at("least").get<double>(), 0.8e6);
    EXPECT_LT(loaded.at("stiffness_N_mm").at("most").get<double>(), 3.1e6);
    EXPECT_GT(loaded.at("pressure_MPa").get<double>(), 70);
    EXPECT_LT(loaded.at("pressure_MPa").get<double>(), 400);
    EXPECT_NEAR(loaded.at("floating_axial_N").get<double>(), 0, 1e-6);
    EXPECT_LT(loaded.at("axial_remainder").at("most").get<double>(), 0.25);
    EXPECT_GE(loaded.at("pairs")[0].get<int>(), 2);
    EXPECT_LE(loaded.at("pairs")[1].get<int>(), 5);
  }
  const std::string page = file_text(out + "/dhfg.html");
  for (const char* words :
       {"Under load", "What the effort changes", "Against the article", "cannot be judged", "532 N m on the gear",
        "friction 0.08", "trial 4: three pairs, then two", "pairs rise with ratio", "decreases, then increases",
        "stress falls with ratio", "stress of trials 7 to 9", "N in trial 8", "of 25 deg", "trial 4 is optimal",
        "covers the whole flank"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(teeth_ratio.size(), 9u);
  EXPECT_EQ(teeth_helix.size(), 9u);
  EXPECT_NE(file_text(out + "/dhfg.html").find("finite elements"), std::string::npos);
}

TEST(DhfgStudy, RefusesAWrongFile) {
  const TestDir dir;
  const std::string file = changed_sample(dir, "studies/dhfg_l9.toml", "ratio = [6, 8, 10]", "ratio = [6, 8]");
  const auto done = run_program({"study", "dhfg", "--file", file, "--out", dir / "out"});
  EXPECT_EQ(done.exit_code, 3);
  EXPECT_NE(done.err.find(":12:9: error: "), std::string::npos) << done.err;
  EXPECT_EQ(run_program({"study", "dhfg", "--file", dir / "none.toml", "--out", dir / "out"}).exit_code, 4);
}

}  // namespace
}  // namespace toothpath::test
