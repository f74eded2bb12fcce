// `toothpath new` as a user has it: every kind of gear on machines of every build is proposed, and the job that it
// writes is verified by `run`; what it refuses names the option that would help.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pty.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using Words = std::vector<std::string>;

Finished run_new(Words words, const std::string& file) {
  words.insert(words.begin(), "new");
  words.insert(words.end(), {"-o", file, "--json"});
  return run_program(words);
}

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += " " + word;
  return text;
}

/// The job that was written, run on its own; @returns its report
nlohmann::json expect_runs(const std::string& file, const std::string& command, const TestDir& dir) {
  const Finished run = run_program(Words{command, file, "--out", dir / "out", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err << file_text(file);
  const auto report = nlohmann::json::parse(run.out)["report"];
  if (command == "run") { EXPECT_EQ(report["verified"], true) << file_text(file); }
  return report;
}

/// What `new` has written is the job that it tried, and the try was a whole run of its own. One job of each way to cut
/// is run once more by the program: it makes the very program of the try.
void expect_tried(const Finished& made, const std::string& file, const std::string& way, const TestDir& dir) {
  const std::string command = way == "shaped" ? "shaper" : "run";
  const auto report = nlohmann::json::parse(made.out)["report"], proof = report["proof"];
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["job"], file_text(file));
  EXPECT_EQ(proof["command"], command);
  if (command == "run") { EXPECT_EQ(proof["verified"], true); }
  EXPECT_GT(proof["program"]["bytes"], 0);
  static std::set<std::string> run_once_more;
  if (!run_once_more.insert(way).second) return;
  EXPECT_EQ(expect_runs(file, command, dir)["program"]["sha256"], proof["program"]["sha256"]);
}

class Proposal : public ::testing::TestWithParam<Words> {};

TEST_P(Proposal, IsVerifiedAsItStands) {
  const TestDir dir;
  const std::string file = dir / "job.toml";
  const Finished made = run_new(GetParam(), file);
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  const auto report = nlohmann::json::parse(made.out)["report"];
  EXPECT_GE(report["limits"].size(), 3U);
  EXPECT_NE(file_text(file).find(" # "), std::string::npos);
  const bool shaped = std::find(GetParam().begin(), GetParam().end(), "shaped") != GetParam().end();
  for (const char* limit : {"swing", "travels needed", "room in travels"})
    EXPECT_EQ(report["limits"].contains(limit), !shaped) << limit;
  expect_tried(made, file, GetParam()[3], dir);
}

Words gear(const char* kind, const char* cut, const char* machine, Words more) {
  Words words = {"--gear", kind, "--cut", cut, "--machine", machine};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

INSTANTIATE_TEST_SUITE_P(
    Gears, Proposal,
    ::testing::Values(
        gear("face", "ball", "xyzac_trt", {"--teeth", "40", "--module", "1.5"}),
        gear("face", "ball", "head_head_ca", {"--teeth", "44", "--module", "2.5"}),
        gear("face", "ball", "nutating_table.toml", {"--teeth", "40", "--module", "1.5", "--helix", "10"}),
        gear("face", "line", "head_table_bc", {"--teeth", "40", "--module", "1.5"}),
        gear("face", "line", "haas_ac_top", {"--teeth", "40", "--module", "1.5"}),
        gear("face", "shaped", "shaper_siemens", {"--teeth", "53", "--module", "2"}),
        gear("offset", "ball", "t600s", {"--teeth", "60", "--module", "1.5"}),
        gear("offset", "line", "siemens_ac_top", {"--teeth", "70", "--module", "2.81"}),
        gear("offset", "line", "t600s", {"--teeth", "60", "--module", "1.5"}),
        gear("offset", "shaped", "y514", {"--teeth", "88", "--module", "3"}),
        gear("double_helical", "ball", "heidenhain_ac_top", {"--teeth", "60", "--module", "1.5"}),
        gear("double_helical", "line", "xyzac_large", {"--teeth", "60", "--module", "1.5"}),
        // Undercut without a shift; the spindle comes in beside the table.
        gear("cylindrical", "ball", "siemens_ac", {"--teeth", "12", "--module", "2.5"}),
        gear("cylindrical_double_helical", "ball", "head_table_bc",
             {"--teeth", "30", "--module", "1", "--helix", "20", "--face-width", "5"}),
        gear("cylindrical_double_helical", "line", "xyzac_large",
             {"--teeth", "30", "--module", "1", "--helix", "20", "--face-width", "5"}),
        gear("spiral_bevel", "ball", "xyzac_large",
             {"--teeth", "12", "--mate-teeth", "36", "--module", "2", "--face-width", "6"}),
        // By the cone distance in the middle of the face, and shafts that the pitch angle says.
        gear("spiral_bevel", "ball", "xyzac_large",
             {"--teeth", "17", "--mate-teeth", "28", "--mean-cone-distance", "33", "--pitch-angle", "22",
              "--face-width", "5", "--cutter-radius", "31.75"}),
        gear("straight_bevel", "ball", "xyzac_trt", {"--teeth", "20", "--mate-teeth", "40", "--module", "2"}),
        gear("straight_bevel", "line", "head_table_bc", {"--teeth", "30", "--mate-teeth", "20", "--module", "2"}),
        gear("bevel_herringbone", "finger", "fanuc_ac_top", {"--teeth", "18", "--mate-teeth", "27", "--module", "2"}),
        gear("bevel_herringbone", "finger", "m80_ac_top", {"--teeth", "24", "--mate-teeth", "36", "--module", "3.4"})));

/// Both gears of a pair roll together: teeth exchanged, the other hand.
TEST(New, WritesTheJobOfTheMateToo) {
  const TestDir dir;
  Words words =
      gear("bevel_herringbone", "finger", "xyzbc_trt", {"--teeth", "18", "--mate-teeth", "27", "--module", "2"});
  words.push_back("--with-mate");
  const std::string pinion = dir / "job.toml", wheel = dir / "job_mate.toml";
  const Finished made = run_new(words, pinion);
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  const auto report = nlohmann::json::parse(made.out)["report"];
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["mate"]["verified"], true);
  EXPECT_NE(file_text(pinion).find("hand = \"left\""), std::string::npos);
  const std::string mate = file_text(wheel);
  EXPECT_NE(mate.find("hand = \"right\""), std::string::npos) << mate;
  EXPECT_NE(mate.find("teeth = 27\nmate_teeth = 18\n"), std::string::npos) << mate;
  const Finished contact = run_program({"contact", pinion, "--mate", wheel, "--out", dir / "out", "--json"});
  EXPECT_EQ(contact.exit_code, 0) << contact.err;

  const Finished none =
      run_new(gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "--with-mate"}), dir / "face.toml");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--with-mate: only bevel gears"), std::string::npos) << none.err;
}

/// Gears that nobody chose: verified, or refused with the option that would help.
TEST(New, RandomGearsAreVerifiedOrRefusedByTheirOption) {
  Random random(16);
  int verified = 0;
  constexpr int kGears = 14;
  for (int i = 0; i < kGears; ++i) {
    const TestDir dir;
    const bool bevel = random(0, 1) < 0.35;
    Words words = {"--gear",   bevel ? "bevel_herringbone" : random(0, 1) < 0.5 ? "face" : "offset",
                   "--teeth",  std::to_string(bevel ? 15 + random.index(15) : 30 + random.index(60)),
                   "--module", fmt::format("{:.2f}", random(0.8, 4))};
    if (bevel) words.insert(words.end(), {"--mate-teeth", std::to_string(24 + random.index(20))});
    else
      words.insert(words.end(), {"--cut", random(0, 1) < 0.3 ? "shaped" : "ball", "--pressure-angle",
                                 fmt::format("{:.1f}", random(19, 25))});
    const bool shaped = std::find(words.begin(), words.end(), "shaped") != words.end();
    words.insert(words.end(), {"--machine", shaped ? "y514" : random(0, 1) < 0.5 ? "xyzac_large" : "siemens_ac"});
    const Finished made = run_new(words, dir / "job.toml");
    if (made.exit_code == 0) {
      ++verified;
      expect_tried(made, dir / "job.toml", bevel ? "finger" : shaped ? "shaped" : "ball", dir);
      continue;
    }
    EXPECT_EQ(made.exit_code, 3) << joined(words) << made.out;
    EXPECT_NE(made.err.find("error: --"), std::string::npos) << joined(words) << made.err;
    EXPECT_FALSE(std::filesystem::exists(dir / "job.toml"));
  }
  EXPECT_GE(verified, kGears - 3);
}

TEST(New, WithoutATerminalAMissingValueNamesItsOption) {
  const TestDir dir;
  const Words all = {"--gear", "face", "--machine", "t600s", "--teeth", "60", "--module", "1.5"};
  for (std::size_t left_out = 0; left_out < all.size(); left_out += 2) {
    Words words = all;
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(left_out),
                words.begin() + static_cast<std::ptrdiff_t>(left_out + 2));
    const Finished made = run_new(words, dir / "job.toml");
    EXPECT_EQ(made.exit_code, 2);
    EXPECT_TRUE(made.err.starts_with("error: " + all[left_out] + " is missing: ")) << made.err;
  }
  // All of them at once.
  const Finished bare = run_program(Words{"new"}), bevel = run_program(Words{"new", "--gear", "straight_bevel"});
  const auto options_of = [](const std::string& err) {
    Words options;
    for (std::size_t at = 0; (at = err.find("error: ", at)) != std::string::npos; ++at)
      options.push_back(err.substr(at + 7, err.find(' ', at + 7) - at - 7));
    return options;
  };
  EXPECT_EQ(options_of(bare.err), (Words{"-o", "--gear", "--machine"})) << bare.err;
  EXPECT_EQ(options_of(bevel.err), (Words{"-o", "--machine", "--teeth", "--mate-teeth", "--module"})) << bevel.err;
  EXPECT_EQ(options_of(run_new({"--gear", "flank_grid"}, dir / "job.toml").err),
            (Words{"--machine", "--points", "--teeth"}));
  EXPECT_FALSE(std::filesystem::exists(dir / "job.toml"));
}

TEST(New, RefusesWithTheOptionAndItsLimit) {
  const TestDir dir;
  const auto err = [&](Words words) {
    const Finished made = run_new(std::move(words), dir / "job.toml");
    EXPECT_FALSE(std::filesystem::exists(dir / "job.toml"));
    return made.err;
  };
  const auto spur = [](Words more) {
    return gear("face", "ball", "xyzac_large", [&] {
      Words words = {"--teeth", "60", "--module", "2"};
      words.insert(words.end(), more.begin(), more.end());
      return words;
    }());
  };
  EXPECT_EQ(err(spur({"--outer", "80"})).substr(0, 70),
            "error: --outer: outer_radius = 80.0000 mm exceeds the pointing limit R");
  EXPECT_EQ(err(spur({"--inner", "50"})).substr(0, 31), "error: --inner: inner_radius = ");
  EXPECT_EQ(err(spur({"--tip-radius", "0"})).substr(0, 94),
            "error: --tip-radius: the largest ball that reaches all of the fillets and the root has 0.000 m");
  EXPECT_EQ(err(spur({"--spiral", "30"})), "error: --spiral does not belong to --gear face\n");
  EXPECT_NE(err({"--gear", "fase"}).find("did you mean \"face\"?"), std::string::npos);
  EXPECT_NE(err(gear("face", "ball", "t60s", {})).find("did you mean \"t600s"), std::string::npos);
  EXPECT_NE(
      err(gear("face", "ball", "y514", {})).find("--machine: y514 is a gear shaper, and ball needs a milling machine"),
      std::string::npos);
  EXPECT_NE(err(gear("face", "ball", "t600s", {"--teeth", "200", "--module", "2"})).find("250"), std::string::npos);
}

TEST(New, FilesOfPointsAndOfRexsAreAskedForByTheirOptions) {
  const TestDir dir;
  const std::string tree = TOOTHPATH_SOURCE_DIR, points = tree + "/samples/flank_grid_spur.csv",
                    pair = tree + "/tests/rexs/bevel_pair.rexs";
  const std::pair<Words, const char*> cases[] = {
      {{"--gear", "flank_grid"}, "error: --points is missing: "},
      {{"--points", points}, "error: --teeth is missing: "},
      {{"--points", points, "--teeth", "200"}, "error: --points-unit is missing, mm or inch: "},
      {{"--points", points, "--teeth", "24", "--root", "1 2 3"}, "error: --root = \"1 2 3\": two places"},
      {{"--points", points, "--teeth", "24", "--fillet-radius", "9"},
       "error: --fillet-radius: fillet_radius = 9.0000 mm"},
      {{"--points", points, "--teeth", "24", "--module", "3"}, "error: --module does not belong to --gear flank_grid"},
      {{"--points", points, "--gear", "face"}, "error: --points does not belong to --gear face"},
      {{"--points", pair}, "bevel_pair.rexs:1:1: error: "},
      {{"--gear", "spiral_bevel"}, "error: --teeth is missing: "},
      {{"--gear", "face", "--hand", "left"}, "error: --hand does not belong to --gear face"},
      {{"--gear", "spiral_bevel", "--teeth", "52", "--mate-teeth", "17", "--module", "2", "--spiral", "15",
        "--cutter-radius", "150"},
       "error: --spiral: spiral_angle = 15 deg is below "},
      {{"--gear", "spiral_bevel", "--teeth", "17", "--mate-teeth", "52", "--module", "2", "--cone-distance", "60"},
       "error: --module and --cone-distance say the same of a gear"},
      {{"--gear", "spiral_bevel", "--teeth", "17", "--mate-teeth", "52", "--mean-cone-distance", "60"},
       "error: --face-width is missing: "},
      {{"--gear", "spiral_bevel", "--teeth", "17", "--mate-teeth", "52", "--pitch-angle", "30"},
       "error: --pitch-angle = 30 deg is not below 19.0"},
      {{"--gear", "spiral_bevel", "--teeth", "17", "--mate-teeth", "52", "--module", "2", "--shaft-angle", "120"},
       "error: --shaft-angle: shaft_angle = 120.0000 deg: the wheel's pitch angle of "},
      {{"--gear", "face", "--teeth", "40", "--shaft-angle", "90"},
       "error: --shaft-angle does not belong to --gear face"},
      {{"--rexs", pair}, "bevel_pair.rexs has bevel_gear 2 (Pinion), bevel_gear 9 (Gear)"},
      {{"--rexs", pair, "--component", "3"}, "error: --component = 3 is no gear of "},
      {{"--rexs", pair, "--component", "2"}, "error: --left-flank is missing, concave or convex: "},
      {{"--rexs", pair, "--component", "2", "--left-flank", "inner"}, "error: --left-flank = inner is neither"},
      {{"--rexs", pair, "--component", "9", "--teeth", "36"}, "error: --teeth does not belong to --rexs"},
      {{"--rexs", pair, "--component", "9", "--gear", "face"}, "error: --gear face: that of --rexs is spiral_bevel"},
      {{"--rexs", points}, "error: no XML: No document"},
      {{"--component", "2"}, "error: --component does not belong to a job without --rexs"},
  };
  for (auto [words, error] : cases) {
    words.insert(words.end(), {"--machine", "xyzac_large"});
    const Finished made = run_new(words, dir / "job.toml");
    EXPECT_NE(made.exit_code, 0) << joined(words);
    EXPECT_NE(made.err.find(error), std::string::npos) << joined(words) << "\n" << made.err;
    EXPECT_TRUE(names_in(dir.path()).empty()) << joined(words);
  }
}

TEST(New, NeverReplacesAFile) {
  const TestDir dir;
  write_file(dir / "job.toml", "mine\n");
  const Finished made =
      run_new(gear("face", "ball", "xyzac_large", {"--teeth", "60", "--module", "2"}), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_NE(made.err.find("exists already, and is not replaced"), std::string::npos);
  EXPECT_EQ(file_text(dir / "job.toml"), "mine\n");
}

/// `key = number` of a job, the last one.
double last_number(const std::string& text, const std::string& key) {
  const auto at = text.rfind("\n" + key + " = ");
  EXPECT_NE(at, std::string::npos) << key << text;
  return at == std::string::npos ? NAN : std::stod(text.substr(at + key.size() + 4));
}

/// The tolerances follow from the class that is asked for, and the job says how; Z 0 is the top of the blank.
TEST(New, TolerancesFollowFromTheQualityAskedFor) {
  const TestDir dir;
  const std::string file = dir / "job.toml";
  const Finished made = run_new(
      gear("face", "ball", "xyzac_large",
           {"--teeth", "60", "--module", "2", "--class", "8", "--coolant", "flood", "--material", "hardened_steel"}),
      file);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string text = file_text(file);
  const double T = 0.001 * 6.1 * std::pow(2, 1.5);  // (0.55 m + 5) sqrt(2)^(8 - 5)
  EXPECT_NEAR(last_number(text, "gouge_tolerance"), 0.2 * T, 1e-4);
  EXPECT_NEAR(last_number(text, "scallop"), 0.4 * T, 1e-4);
  EXPECT_NEAR(last_number(text, "chord_tolerance"), 0.08 * T, 1e-4);
  EXPECT_LT(last_number(text, "gouge_tolerance") + last_number(text, "scallop") + last_number(text, "chord_tolerance"),
            T);
  EXPECT_NE(
      text.find("# Form of the flanks: T = 17.25 um, ISO 1328-1 class 8: f_f_alpha = (0.55 m + 5) sqrt(2)^(8 - 5) "
                "with m = 2 mm, the standard of cylindrical gears.\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("\n[coolant]\nmode = \"flood\"\n"), std::string::npos) << text;
  // Chips of 5 and 50 um cost K h + K_e = 4650 h^0.76 N for a mm of edge, to the two digits that are written.
  EXPECT_EQ(last_number(text, "cutting_coefficient"), 8800) << text;
  EXPECT_EQ(last_number(text, "edge_coefficient"), 39) << text;
  for (const double h : {0.005, 0.05}) EXPECT_NEAR(8800 * h + 39, 4650 * std::pow(h, 0.76), 0.01 * 8800 * h + 0.6);
  EXPECT_NE(text.find("# on the gear axis; Z 0 is the top of the blank\n"), std::string::npos) << text;
  EXPECT_LT(nlohmann::json::parse(made.out)["report"]["proof"]["gouge_um"]["bound"], 1000 * 0.2 * T);
}

TEST(New, RefusesConditionsThatDoNotHold) {
  const TestDir dir;
  const std::pair<Words, const char*> cases[] = {
      {{"xyzac_large", "--class", "6", "--tolerance", "8"}, "error: --class and --tolerance say the same of a gear"},
      {{"xyzac_large", "--coolant", "through_spindle"}, "error: --coolant = through_spindle: "},
      {{"xyzac_large", "--material", "stone"}, "error: --material = \"stone\" is not one of steel, hardened_steel, "},
      {{"xyzac_large", "--blank-top", "80"}, "error: --blank-top counts from the face of the table, and "},
      {{"t600s", "--accept-assumed", "no"}, "error: --accept-assumed: T-600S has values that are assumed ("},
      {{"t600s", "--accept-assumed", "perhaps"}, "error: --accept-assumed = \"perhaps\" is not one of yes, no"},
  };
  for (const auto& [words, error] : cases) {
    Words all = gear("face", "ball", words.front().c_str(), {"--teeth", "60", "--module", "1.5"});
    all.insert(all.end(), words.begin() + 1, words.end());
    const Finished made = run_new(all, dir / "job.toml");
    EXPECT_NE(made.exit_code, 0) << joined(all);
    EXPECT_TRUE(made.err.starts_with(error)) << joined(all) << "\n" << made.err;
  }
  const Finished shaped =
      run_new(gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "--class", "6"}), dir / "job.toml");
  EXPECT_TRUE(shaped.err.starts_with("error: --class does not belong to --cut shaped")) << shaped.err;
  const Finished soft = run_new(
      gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "--material", "steel"}), dir / "job.toml");
  EXPECT_TRUE(soft.err.starts_with("error: --material does not belong to --cut shaped")) << soft.err;
  EXPECT_TRUE(names_in(dir.path()).empty());
}

constexpr const char* kFusion = R"({"version": 36, "data": [
 {"type": "ball end mill", "description": "1 mm ball", "unit": "millimeters", "post-process": {"number": 4},
  "geometry": {"DC": 1, "LCF": 7, "LB": 27, "SFDM": 4, "NOF": 2, "assemblyGaugeLength": 97},
  "holder": {"description": "ER11", "unit": "millimeters", "gaugeLength": 70, "segments": [{"height": 30, "lower-diameter": 11, "upper-diameter": 11}]}},
 {"type": "drill", "unit": "millimeters", "post-process": {"number": 8}, "geometry": {"DC": 5}}]})";

/// A spur gear with these tools.
Words with_tools(const std::string& file, Words more = {}) {
  Words words = gear("face", "ball", "xyzac_large", {"--teeth", "60", "--module", "2", "--tools", file});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(New, WhatANameMeansInTomlIsEscaped) {
  const TestDir dir;
  const std::string name = "\"5\" \\wheel\"\nteeth = 3";
  const Finished refused =
      run_new(gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "--name", name}), dir / "job.toml");
  EXPECT_EQ(refused.exit_code, 3) << refused.err;  // a line feed is no part of a name
  EXPECT_TRUE(names_in(dir.path()).empty());
  const Finished made =
      run_new(gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "--name", "\"5\" \\wheel\""}),
              dir / "job.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(file_text(dir / "job.toml").find("name = \"\\\"5\\\" \\\\wheel\\\"\"\n"), std::string::npos);
  const Finished run = run_program({"surface", dir / "job.toml", "--out", dir / "out", "--json"});
  EXPECT_EQ(nlohmann::json::parse(run.out)["report"]["job"], "\"5\" \\wheel\"");
}

TEST(New, ALibraryInAFolderWithQuotesIsNamed) {
  const TestDir dir;
  const std::string folder = dir / "my \"tools\"";
  std::filesystem::create_directory(folder);
  write_file(folder + "/lib.json", kFusion);
  const Finished made = run_new(with_tools(folder + "/lib.json", {"--tool", "4: helix = 30"}), dir / "job.toml");
  EXPECT_NE(made.exit_code, 70) << made.err;
  if (made.exit_code == 0) {
    EXPECT_NE(file_text(dir / "job.toml").find("library = \"my \\\"tools\\\"/lib.json\""), std::string::npos);
  }
  const std::string latin = dir /
                            "L\xf6"
                            "ffel";
  std::filesystem::create_directory(latin);
  write_file(latin + "/lib.json", kFusion);
  const Finished refused = run_new(with_tools(latin + "/lib.json"), dir / "other.toml");
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find("lib.json: error: --tools: a job cannot name it"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "other.toml"));
}

TEST(New, WithoutAFolderForTriesNothingIsWritten) {
  const TestDir dir;
  Launch launch;
  launch.arguments = gear("face", "shaped", "y514", {"--teeth", "53", "--module", "2", "-o", dir / "job.toml"});
  launch.arguments.insert(launch.arguments.begin(), "new");
  launch.in_child = [] { ::setenv("TMPDIR", "/nowhere/at/all", 1); };
  const Finished refused = run_program(launch);
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_TRUE(refused.err.starts_with("/nowhere/at/all: error: cannot make a folder")) << refused.err;
  EXPECT_TRUE(names_in(dir.path()).empty());
}

/// What a terminal shows while these lines are typed, and `then`, once it shows `when`.
std::string on_terminal(const Words& words, const std::string& typed, int& exit_code, std::string when = {},
                        const std::string& then = {}) {
  int master = -1;
  const pid_t child = ::forkpty(&master, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(TOOTHPATH_BINARY, argv.data());
    ::_exit(127);
  }
  EXPECT_EQ(::write(master, typed.data(), typed.size()), static_cast<ssize_t>(typed.size()));
  std::string shown;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(master, buffer, sizeof buffer)) > 0;) {
    shown.append(buffer, static_cast<std::size_t>(n));
    if (when.empty() || shown.find(when) == std::string::npos) continue;
    EXPECT_EQ(::write(master, then.data(), then.size()), static_cast<ssize_t>(then.size()));
    when.clear();
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(master);
  exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return shown;
}

TEST(New, AsksOnATerminalAndShowsLimitsBeforeTheEndsOfTheTeeth) {
  const TestDir dir;
  int exit_code = -1;
  const std::string shown =
      on_terminal({TOOTHPATH_BINARY, "new", "-o", dir / "job.toml"},
                  "gace\nface\nball\nxyzac_large\nclass 12\nclass 7\n\n\n9\n60\n\n2\n\n\n\n\n\n", exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_NE(shown.find("did you mean \"face\"?"), std::string::npos) << shown;
  EXPECT_NE(shown.find("teeth of the gear (10 to 1000): "), std::string::npos) << shown;
  EXPECT_NE(shown.find("teeth of the gear = 9 is not a whole number from 10 to 1000"), std::string::npos)
      << shown;  // 9 teeth: asked again
  const auto limits = shown.find("the teeth are pointed at: "),
             asked = shown.find("inner end of the teeth, radius (1 to 2000 mm) [");
  EXPECT_LT(limits, asked) << shown;
  EXPECT_NE(asked, std::string::npos) << shown;
  EXPECT_NE(shown.find("largest ball that reaches the root"), std::string::npos);
  EXPECT_LT(shown.find("largest part that turns: 1200 mm"), limits) << shown;
  EXPECT_LT(shown.find("outer end that turns on "), asked) << shown;
  const auto outer = shown.find("outer end of the teeth, radius (1 to 2000 mm) [");
  const auto swing = shown.find("swing: 134.5 mm of 1200 mm"), travels = shown.find("travels needed: X ");
  EXPECT_LT(outer, swing) << shown;
  EXPECT_LT(swing, travels) << shown;
  EXPECT_LT(travels, shown.find("room in travels: X ")) << shown;
  EXPECT_LT(travels, shown.find("distance index")) << "before anything is planned\n" << shown;
  EXPECT_NE(shown.find("class = 12 is not a whole number from 1 to 11, or a class: \"class 6\""), std::string::npos)
      << shown;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("teeth = 60\n"), std::string::npos);
  EXPECT_NE(text.find("# Form of the flanks: T = 12.20 um, ISO 1328-1 class 7: "), std::string::npos) << text;
}

/// A face gear for a shaper is soon tried: its questions are --teeth, --shaper-teeth, --module, --pressure-angle,
/// --helix,
/// --tip-radius, --inner, --outer.
Words shaped_face_gear(const std::string& file) {
  return {TOOTHPATH_BINARY, "new",  "--gear",           "face", "--cut", "shaped",
          "--machine",      "y514", "--accept-assumed", "yes",  "-o",    file};
}

TEST(New, ExplainsGoesBackAndAsksAgainForWhatCannotBeMade) {
  const TestDir dir;
  int exit_code = -1;
  const std::string shown = on_terminal(shaped_face_gear(dir / "job.toml"),
                                        "<\n?\n43\n<\n53\n\n2,0\n2 inch\n 2 mm \n\n\n\n\n90\n\n", exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_NE(shown.find("this is the first question"), std::string::npos) << shown;
  EXPECT_NE(shown.find("Of the gear that is cut here, not of its mate (option --teeth;"), std::string::npos) << shown;
  EXPECT_NE(shown.find("= 2,0: a comma is not read"), std::string::npos) << shown;
  EXPECT_NE(shown.find("2 inch is not a number from 0.3 to 20 mm"), std::string::npos) << shown;
  EXPECT_NE(shown.find("not possible: --outer: "), std::string::npos) << "the teeth are pointed before 90\n" << shown;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("\nteeth = 53\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nmodule = 2.0"), std::string::npos) << text;
  EXPECT_EQ(names_in(dir.path()).size(), 1U) << "the answers are kept no longer than they are needed";
}

/// Assumed values are shown and accepted in words; the blank stands as high as the shop clamps it.
TEST(New, AsksForAssumedValuesAndWhereTheBlankStands) {
  const TestDir dir;
  int exit_code = -1;
  const std::string shown = on_terminal({TOOTHPATH_BINARY, "new", "--gear", "face", "--cut", "ball", "--machine",
                                         "t600s", "--teeth", "60", "--module", "1.5", "-o", dir / "job.toml"},
                                        "no\nyes\n12 um\naluminium\n\nhigh\n60\n\n\n\n\n\n\n", exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_NE(shown.find("assumed in the machine file, measured by nobody: "), std::string::npos) << shown;
  EXPECT_NE(shown.find("not possible: --accept-assumed: T-600S has values that are assumed ("), std::string::npos)
      << shown;
  const std::string face = "face of the table: machine Z ";
  const auto at = shown.find(face);
  ASSERT_NE(at, std::string::npos) << shown;
  EXPECT_NE(shown.find(", or \"any\""), std::string::npos) << shown;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("# Form of the flanks: T = 12.00 um, as asked for.\n"), std::string::npos) << text;
  EXPECT_EQ(last_number(text, "cutting_coefficient"), 1500) << text;
  EXPECT_EQ(last_number(text, "edge_coefficient"), 7.3) << text;
  const auto zero = text.find("work_offset_at = [0.0, 0.0, ");
  ASSERT_NE(zero, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(zero + 28)), std::stod(shown.substr(at + face.size())) + 60, 1e-3) << text;
}

TEST(New, AnswersOutliveCtrlC) {
  const TestDir dir;
  const std::string file = dir / "job.toml", kept = file + ".answers";
  int exit_code = -1;
  std::string shown = on_terminal(shaped_face_gear(file), "53\n\n2\n", exit_code, "pressure angle (", "\x03");
  EXPECT_EQ(exit_code, 130) << shown;
  EXPECT_NE(shown.find("interrupted: the answers are kept in "), std::string::npos) << shown;
  EXPECT_EQ(file_text(kept),
            "# answers to `toothpath new`: the same command with --resume goes on with them\n"
            "--teeth\t53\n--shaper-teeth\t\n--module\t2\n");
  shown = on_terminal(shaped_face_gear(file), "", exit_code);
  EXPECT_EQ(exit_code, 2) << shown;
  EXPECT_NE(shown.find("job.toml.answers keeps answers to an earlier `new`: --resume goes on"), std::string::npos)
      << shown;
  Words resume = shaped_face_gear(file);
  resume.push_back("--resume");
  shown = on_terminal(resume, "\n\n\n\n\n", exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_EQ(shown.find("teeth of the gear"), std::string::npos) << "it was said\n" << shown;
  EXPECT_NE(file_text(file).find("\nteeth = 53\n"), std::string::npos);
  EXPECT_EQ(names_in(dir.path()).size(), 1U);
}

TEST(New, WhatAreNoAnswersIsRefusedAndStays) {
  const TestDir dir;
  const std::string file = dir / "job.toml", kept = file + ".answers";
  Words resume = shaped_face_gear(file);
  resume.push_back("--resume");
  int exit_code = -1;
  std::string shown = on_terminal(resume, "", exit_code);
  EXPECT_EQ(exit_code, 4) << shown;
  for (const std::string& damaged :
       {std::string("somebody's letter\n"),
        std::string("# answers to `toothpath new`: the same command with --resume goes on with them\n--teeth 53\n")}) {
    write_file(kept, damaged);
    shown = on_terminal(resume, "53\n", exit_code);
    EXPECT_EQ(exit_code, 3) << shown;
    EXPECT_NE(shown.find("job.toml.answers:"), std::string::npos) << shown;
    EXPECT_EQ(file_text(kept), damaged);
  }
  resume.front() = "new";
  resume.erase(resume.begin() + 1);
  const Finished without = run_program(resume);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("--resume goes on with questions: it needs a terminal"), std::string::npos) << without.err;
}

TEST(New, TakesTheToolsOfAnotherJob) {
  const TestDir dir;
  Words words =
      gear("face", "ball", "xyzac_large", {"--teeth", "60", "--module", "2", "--tools", kSamples + "/spur_quick.toml"});
  const Finished made = run_new(words, dir / "job.toml");
  const std::string text = file_text(dir / "job.toml"), from = file_text(kSamples + "/spur_quick.toml");
  const auto stick_out = from.find("stick_out = ");
  ASSERT_NE(stick_out, std::string::npos);
  EXPECT_NE(text.find(from.substr(stick_out, from.find_first_of(" \n", stick_out + 12) - stick_out)), std::string::npos)
      << made.err << text;
}

TEST(New, AsksAgainForWhatTheMachineDoesNotTurn) {
  const TestDir dir;
  int exit_code = -1;
  const std::string shown = on_terminal({TOOTHPATH_BINARY, "new", "--gear", "face", "--cut", "ball", "--machine",
                                         "t600s", "--teeth", "150", "--module", "1.5", "-o", dir / "job.toml"},
                                        "\n\n\n\n\n"
                                        "\n\n\n\n\n126\n116\n",
                                        exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_NE(shown.find("outer end that turns on T-600S: up to 125 mm"), std::string::npos) << shown;
  EXPECT_NE(
      shown.find("too large: --machine: part diameter = 252.0000 mm exceeds 250.0000 mm, the largest that turns on "
                 "T-600S: fewer teeth or a smaller module would fit, or a machine that turns so much: "),
      std::string::npos)
      << shown;
  EXPECT_NE(shown.find("xyzac_large"), std::string::npos) << shown;
  EXPECT_NE(shown.find("swing: 232.0 mm of 250 mm"), std::string::npos) << shown;
}

TEST(New, RefusesASwingBeforeTheGearIsMade) {
  const TestDir dir;
  const auto err = [&](Words words) { return run_new(std::move(words), dir / "job.toml").err; };
  const std::string bevel =
      err(gear("bevel_herringbone", "finger", "t600s", {"--teeth", "60", "--mate-teeth", "60", "--module", "5"}));
  EXPECT_TRUE(bevel.starts_with("error: --machine: part diameter = 304.")) << bevel;
  EXPECT_NE(bevel.find("or a machine that turns so much: "), std::string::npos) << bevel;
  const std::string face = err(gear("face", "ball", "t600s", {"--teeth", "170", "--module", "1.5", "--outer", "130"}));
  EXPECT_NE(face.find(" exceeds 250.0000 mm, the largest that turns on T-600S: "), std::string::npos) << face;
}

/// A machine like another, but for its travels.
std::string changed_machine(const TestDir& dir, const std::string& from, const std::string& to) {
  const std::string text = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/t600s.toml");
  write_file(dir / "small.toml", replaced(text, from, to));
  return "small";  // beside the job
}

TEST(New, NamesEveryTravelThatIsTooShort) {
  const TestDir dir;
  const std::string small = changed_machine(dir, "min = -200.0\nmax = 200.0", "min = -20.0\nmax = 20.0");
  const Finished made =
      run_new(gear("face", "ball", small.c_str(), {"--teeth", "60", "--module", "1.5"}), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 3);
  const auto at =
      made.err.find("error: --machine: T-600S has not the travel for this gear at its best place with a tool of ");
  EXPECT_NE(at, std::string::npos) << made.err;
  EXPECT_NE(made.err.find(": Y lacks "), std::string::npos) << made.err;
  EXPECT_NE(made.err.find(" needed of 40): a smaller gear, a shorter tool, or a machine that travels farther"),
            std::string::npos)
      << made.err;
}

TEST(New, OffersTheMachineBesideTheJobFirst) {
  const TestDir dir;
  const std::string small = changed_machine(dir, "max_speed = 20000", "max_speed = 19000");
  write_file(dir / "other_job.toml", file_text(kSamples + "/spur_quick.toml"));
  for (const std::string answer : {"", "small", "small.toml", "./small.toml"}) {
    int exit_code = -1;
    const std::string shown = on_terminal({TOOTHPATH_BINARY, "new", "-o", dir / "job.toml"},
                                          "face\nball\nsmal\n" + answer + "\n\x04", exit_code);
    EXPECT_EQ(exit_code, 2) << "the answers end behind it\n" << shown;
    EXPECT_NE(shown.find("machines beside the job: small\r\n"), std::string::npos) << shown;
    EXPECT_NE(shown.find("machine: the name or the path of its file [small]: "), std::string::npos) << shown;
    EXPECT_NE(shown.find("machine file \"smal\" is neither beside the job nor installed"), std::string::npos) << shown;
    EXPECT_NE(shown.find("largest part that turns: 250 mm"), std::string::npos) << answer << shown;
    std::filesystem::remove(dir / "job.toml.answers");
  }
}

TEST(New, FindsAMachineBesideTheJob) {
  const TestDir dir;
  const std::string small = changed_machine(dir, "max_speed = 20000", "max_speed = 19000");
  const Finished made =
      run_new(gear("face", "ball", small.c_str(), {"--teeth", "60", "--module", "1.5"}), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("\"travels needed\":\"X "), std::string::npos) << made.out;
  expect_runs(dir / "job.toml", "run", dir);
}

TEST(New, TakesTheToolsOfAFusionLibrary) {
  const TestDir dir;
  write_file(dir / "lib.json", kFusion);
  const Finished made = run_new(with_tools(dir / "lib.json"), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("[[tool]]\nnumber = 4\nlibrary = \"lib.json\" "), std::string::npos) << text;
  EXPECT_NE(text.find("tool = 4\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("stick_out"), std::string::npos) << "the library says it\n" << text;
  expect_runs(dir / "job.toml", "run", dir);
}

TEST(New, NamesWhatALibraryDoesNotSay) {
  const TestDir dir;
  write_file(dir / "shop.tbl", "T1 P1 D1 Z80 ; ball nose\nT2 P2 D16 Z80\nT12 P3 D0.8\n");
  const Finished made = run_new(with_tools(dir / "shop.tbl"), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 2);
  const std::string all =
      "shank_diameter (0.01 to 500 mm), stick_out (above 0 to 2000 mm), holder ([[lower diameter, upper diameter, "
      "height], ..], each above 0 to 2000 mm), flute_length (above 0 to 2000 mm)";
  EXPECT_NE(
      made.err.find("does not say all of its tools that would do: tool 1 (ball nose) lacks type (one of "
                    "ball_end_mill), " +
                    all + "; tool 12 lacks type (one of ball_end_mill), shank_diameter (0.01 to 500 mm), length "),
      std::string::npos)
      << made.err;
  EXPECT_EQ(made.err.find("tool 2"), std::string::npos) << "a ball of 16 mm does not fit the tooth spaces\n"
                                                        << made.err;
  EXPECT_NE(made.err.find("say it with --tool, as --tool \"NUMBER: KEY = VALUE"), std::string::npos) << made.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "job.toml"));
}

const std::string kRest =
    "type = 'ball_end_mill', shank_diameter = 4, stick_out = 27, holder = [[11, 11, 30]], flute_length = 7";

TEST(New, TakesWhatALibraryDoesNotSayByOptions) {
  const TestDir dir;
  write_file(dir / "shop.tbl", "T1 P1 D16 Z80\nT12 P3 D1 Z80 ; ball nose\n");
  const Finished made = run_new(with_tools(dir / "shop.tbl", {"--tool", "12: " + kRest}), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("number = 12\nlibrary = \"shop.tbl\" "), std::string::npos) << text;
  for (const char* said : {"\ntype = \"ball_end_mill\"\n", "\nshank_diameter = 4\n", "\nstick_out = 27\n",
                           "\nholder = [[11, 11, 30]]\n", "\nflute_length = 7\n", "\ntool = 12\n"})
    EXPECT_NE(text.find(said), std::string::npos) << said << text;
  EXPECT_EQ(text.find("diameter = 1"), std::string::npos) << "the table says it\n" << text;
  expect_runs(dir / "job.toml", "run", dir);
}

TEST(New, RefusesAWrongWordOfATool) {
  const TestDir dir;
  write_file(dir / "shop.tbl", "T12 P3 D1 Z80 ; ball nose\n");
  const auto err = [&](const std::string& said) {
    const Finished made = run_new(with_tools(dir / "shop.tbl", {"--tool", said}), dir / "job.toml");
    EXPECT_EQ(made.exit_code, 2) << said;
    return made.err;
  };
  EXPECT_NE(err("12: " + kRest + ", stik_out = 3").find("error: --tool 12: unknown key \"stik_out\" in [tool]"),
            std::string::npos);
  EXPECT_NE(err("12: stick_out = -1").find("error: --tool 12: stick_out = -1 "), std::string::npos);
  EXPECT_NE(err("12: number = 3").find("--tool 12: number is not said here"), std::string::npos);
  EXPECT_NE(err("3: stick_out = 1").find("there is no tool 3, but 12"), std::string::npos);
  EXPECT_NE(err("x: stick_out = 1").find("--tool = x is not a whole number from 1 to 9999"), std::string::npos);
  EXPECT_NE(err("stick_out = 1").find("its number, a colon and keys"), std::string::npos);
  EXPECT_NE(err("12: stick_out = }").find("are no keys with values"), std::string::npos);
  const Finished none =
      run_new(gear("face", "ball", "xyzac_large", {"--teeth", "60", "--module", "2", "--tool", "1: teeth = 2"}),
              dir / "job.toml");
  EXPECT_NE(none.err.find("--tools names none"), std::string::npos) << none.err;
}

/// One ball mill of a Fusion library, in millimetres, in a collet of 30 mm.
std::string fusion_ball(int number, const std::string& geometry) {
  return fmt::format(
      R"({{"type": "ball end mill", "unit": "millimeters", "post-process": {{"number": {}}}, "geometry": {{{}}}, "holder":
      {{"unit": "millimeters", "gaugeLength": 70, "segments": [{{"height": 30, "lower-diameter": 11, "upper-diameter": 11}}]}}}})",
      number, geometry);
}

/// Tools that cannot do are not offered, and why stands there; one that is not chosen is not asked about.
TEST(New, OffersOnlyToolsThatReachAndSaysWhyTheOthersDoNot) {
  const TestDir dir;
  write_file(dir / "lib.json", R"({"data": [)" + fusion_ball(1, R"("DC": 1, "LCF": 7, "LB": 27, "SFDM": 4, "NOF": 2)") +
                                   "," + fusion_ball(2, R"("DC": 1.2, "LB": 27, "SFDM": 4)") + "," +
                                   fusion_ball(3, R"("DC": 16, "LCF": 30, "LB": 60, "SFDM": 16)") + "," +
                                   fusion_ball(4, R"("DC": 1, "LCF": 1.5, "LB": 27, "SFDM": 4)") + R"(,
    {"type": "bull nose end mill", "unit": "millimeters", "post-process": {"number": 5}, "geometry": {"DC": 4}},
    {"type": "drill", "description": "pilot", "post-process": {"number": 7}}]})");
  Words words = with_tools(dir / "lib.json", {"-o", dir / "job.toml"});
  words.insert(words.begin(), {TOOTHPATH_BINARY, "new"});
  int exit_code = -1;
  const std::string shown = on_terminal(words,
                                        "\n\n\n"
                                        "\n\n\n\n\n\n4\n1\n",
                                        exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  for (const char* line :
       {"tool 1: whole", "tool 2: lacks flute_length", "tool 3: not offered: 16 mm wide: at most ",
        "tool 4: not offered: flutes of 1.5 mm end above the root, 4.50 mm below the tips, and its shank of 4 mm is "
        "thicker than its ball",
        "tool 5: not offered: bull_nose_end_mill: this way to cut takes ball_end_mill",
        "tool 7 (pilot): not offered: drill: a kind that no job has"})
    EXPECT_NE(shown.find(line), std::string::npos) << line << "\n" << shown;
  EXPECT_NE(shown.find("one of the numbers above"), std::string::npos) << "4 is not offered\n" << shown;
  EXPECT_EQ(shown.find("tool 2: flute_length"), std::string::npos) << "it was not chosen\n" << shown;
}

/// Where no tool reaches the root, none is asked about: the number of the gear that is in the way is asked for again.
TEST(New, AsksNothingAboutToolsOfWhichNoneReachesTheRoot) {
  const TestDir dir;
  write_file(dir / "shop.tbl", "T1 P1 D1.9 Z80\nT2 P2 D1.7 Z80\n");
  Words words = with_tools(dir / "shop.tbl", {"-o", dir / "job.toml"});
  words.insert(words.begin(), {TOOTHPATH_BINARY, "new"});
  int exit_code = -1;
  const std::string shown = on_terminal(words,
                                        "\n\n\n"
                                        "\n\n\n0.2\n\n\n\x04",
                                        exit_code);
  EXPECT_EQ(exit_code, 2) << "the answers end\n" << shown;
  EXPECT_EQ(shown.find("that may be used"), std::string::npos) << shown;
  EXPECT_NE(shown.find(" has no ball mill that reaches the root of the tooth spaces, at most 0.388 mm wide and 4.50 mm "
                       "deep; a larger rounding of the shaper's tip takes a larger ball; tool 1: it may rough, but"),
            std::string::npos)
      << shown;
  EXPECT_NE(shown.find("not possible: --tip-radius: "), std::string::npos) << shown;
  EXPECT_NE(shown.find("tool 2: it may rough, but no ball_end_mill of this library reaches the root: that takes 0."),
            std::string::npos)
      << shown;
}

/// Short flutes are enough where a neck no thicker than the ball goes on to the holder.
TEST(New, AMillWithANeckNeedsNoFlutesAsDeepAsTheTeeth) {
  const TestDir dir;
  write_file(dir / "lib.json",
             R"({"data": [)" +
                 fusion_ball(4, R"("DC": 1, "LCF": 2, "LB": 16, "SFDM": 4, "NOF": 2, "shoulder-diameter": 0.95,
                                  "shoulder-length": 16)") +
                 "]}");
  const Finished made = run_new(with_tools(dir / "lib.json"), dir / "job.toml");
  EXPECT_EQ(made.exit_code, 0) << made.err << made.out;
  EXPECT_NE(file_text(dir / "job.toml").find("[[tool]]\nnumber = 4\nlibrary = \"lib.json\" "), std::string::npos);
}

TEST(New, AsksOnATerminalForWhatALibraryDoesNotSay) {
  const TestDir dir;
  write_file(dir / "shop.tbl", "T1 P1 D16 Z80\nT12 P3 D1 Z80 ; ball nose\n");
  Words words = with_tools(dir / "shop.tbl", {"-o", dir / "job.toml"});
  words.insert(words.begin(), {TOOTHPATH_BINARY, "new"});
  int exit_code = -1;
  // The numbers of the gear; the tools; a wrong kind, the right one; a wrong shank, the right one; the rest.
  const std::string shown = on_terminal(words,
                                        "\n\n\n"
                                        "\n\n\n\n\n\n7\n\nflat_end_mill\nball_end_mill\n-4\n4\n27\n[[11, 11, 30]]\n7\n",
                                        exit_code);
  EXPECT_EQ(exit_code, 0) << shown;
  EXPECT_NE(shown.find("tool 12 (ball nose): lacks type (one of ball_end_mill), "), std::string::npos) << shown;
  EXPECT_NE(shown.find("tools of "), std::string::npos) << shown;
  EXPECT_NE(shown.find(" that may be used, by number [12]: "), std::string::npos) << shown;
  EXPECT_NE(shown.find("one of the numbers above"), std::string::npos) << "there is no tool 7\n" << shown;
  EXPECT_NE(shown.find("type = \"flat_end_mill\" is not one of ball_end_mill"), std::string::npos) << shown;
  EXPECT_NE(shown.find("--tool 12: shank_diameter = -4"), std::string::npos) << shown;
  for (const char* asked :
       {"shank_diameter (0.01 to 500 mm): ", "stick_out (above 0 to 2000 mm): ", "flute_length (above 0 to 2000 mm): "})
    EXPECT_NE(shown.find("tool 12 (ball nose): " + std::string(asked)), std::string::npos) << asked << shown;
  const std::string text = file_text(dir / "job.toml");
  EXPECT_NE(text.find("number = 12\nlibrary = \"shop.tbl\" "), std::string::npos) << text;
  EXPECT_NE(text.find("\nstick_out = 27\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nholder = [[11, 11, 30]]\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace toothpath::test
