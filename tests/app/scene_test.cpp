// `toothpath check` with meshes of fixture and stock: planted collisions of every kind are found, clean scenes pass.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/check_scene.h"

namespace toothpath::test {
namespace {

// The quick spur job: 60 teeth, radii 60 to 65, tips at z = -18, rapids of the tip at z = -16, deepest cut near z =
// -22.5; the holder (radius 5, 40 high) begins 16 above the tip, the flute ends 6 above it.
class SceneTest : public CheckScene {
 protected:
  static void SetUpTestSuite() { run_sample("spur_quick.toml"); }
  /// A block between two radii at a tooth; the spaces are cut half a pitch further on.
  static mesh::TriangleMesh block(double tooth, double r0, double r1, double half, double z0, double z1) {
    mesh::TriangleMesh mesh = box(Vec3(r0, -half, z0), Vec3(r1, half, z1));
    const double angle = 2 * M_PI * tooth / 60;
    for (auto& v : mesh.vertices)
      v = Vec3(std::cos(angle) * v.x() - std::sin(angle) * v.y(), std::sin(angle) * v.x() + std::cos(angle) * v.y(),
               v.z());
    return mesh;
  }
};

TEST_F(SceneTest, WithoutMeshesNothingIsLoaded) { expect_nothing_loaded_without_meshes(); }

TEST_F(SceneTest, CleanFixtureAndStockPass) {
  const std::string plate = stl("plate.stl", box(Vec3(-80, -80, -60), Vec3(80, 80, -40)));
  const std::string blank = stl("blank.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -18)));
  const auto finished = check({"--fixture", plate, "--stock", blank});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(report_["fixture"]["clear"].get<bool>());
  EXPECT_TRUE(report_["fixture"]["clearance"].is_null()) << "more than 17 mm away";
  EXPECT_TRUE(report_["stock"]["clear"].get<bool>());
  EXPECT_NE(finished.out.find("fixture"), std::string::npos);
  EXPECT_GT(report_["fixture"]["motions"].get<int>(), 60 * 1000) << "every tooth";
}

TEST_F(SceneTest, HolderOnlyAndOneToothOnly) {
  // Outside the ring, high enough for the holder alone, at tooth 30 alone.
  const std::string clamp = stl("clamp.stl", block(30, 67.5, 75, 1.5, -30, -4));
  const auto finished = check({"--fixture", clamp});
  EXPECT_EQ(finished.exit_code, 1);
  const Json& fixture = report_["fixture"];
  EXPECT_FALSE(fixture["clear"].get<bool>());
  ASSERT_FALSE(fixture["worst"].empty());
  for (const auto& w : fixture["worst"]) {
    EXPECT_EQ(w["body"], "holder");
    EXPECT_NEAR(w["tooth"].get<int>(), 30, 5) << "the holder is 10 mm wide, a pitch 6 mm";
    EXPECT_GT(w["line"].get<int>(), 0);
  }
  EXPECT_NE(finished.err.find("fixture: holder"), std::string::npos) << finished.err;
  EXPECT_NE(finished.out.find("holder"), std::string::npos);
}

TEST_F(SceneTest, CutterAgainstAClampInsideTheRing) {
  const std::string clamp = stl("stop.stl", block(7.5, 55, 59.2, 1, -30, -21));
  EXPECT_EQ(check({"--fixture", clamp}).exit_code, 1);
  ASSERT_FALSE(report_["fixture"]["worst"].empty());
  for (const auto& w : report_["fixture"]["worst"]) {
    EXPECT_EQ(w["body"], "cutter");
    EXPECT_NEAR(w["tooth"].get<int>(), 7, 1);
  }
}

TEST_F(SceneTest, RapidOnly) {
  // High above the tool as it cuts, in the way of its first descent.
  const std::string bridge = stl("bridge.stl", box(Vec3(58, 1, 60), Vec3(61, 5, 61)));
  EXPECT_EQ(check({"--fixture", bridge}).exit_code, 1);
  ASSERT_FALSE(report_["fixture"]["worst"].empty());
  for (const auto& w : report_["fixture"]["worst"]) EXPECT_TRUE(w["rapid"].get<bool>());
}

TEST_F(SceneTest, StockInTheWayOfRapidsAndOfTheShank) {
  const std::string high = stl("high.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -15.9)));
  EXPECT_EQ(check({"--stock", high}).exit_code, 1);
  bool rapid = false, shank = false;
  for (const auto& w : report_["stock"]["worst"]) {
    rapid = rapid || w["rapid"].get<bool>();
    shank = shank || (w["body"] == "shank" && !w["rapid"].get<bool>());
    EXPECT_TRUE(w["rapid"].get<bool>() || w["body"] != "cutter") << "the cutter may cut the stock";
  }
  EXPECT_TRUE(rapid);
  // The shank begins 6 above the tip: -16.5 at the deepest place.
  const std::string boss = stl("boss.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -16.2)));
  EXPECT_EQ(check({"--stock", boss}).exit_code, 1);
  for (const auto& w : report_["stock"]["worst"]) {
    EXPECT_EQ(w["body"], "shank");
    EXPECT_FALSE(w["rapid"].get<bool>());
  }
}

// A stock that cannot become the gear proves nothing about the program.
TEST_F(SceneTest, AStockThatDoesNotHoldTheGearIsRefused) {
  mesh::TriangleMesh hollow = box(Vec3(-66, -66, -45), Vec3(66, 66, -18)),
                     hole = box(Vec3(62, -0.4, -20.5), Vec3(62.8, 0.4, -19.5));  // within tooth 0
  for (auto& t : hole.triangles) std::swap(t[1], t[2]);
  append(hollow, hole);
  struct Case {
    const char* name;
    mesh::TriangleMesh stock;
    const char* words;
  };
  for (const Case& c : {Case{"off.stl", box(Vec3(234, -66, -45), Vec3(366, 66, -18)), "mm out of the stock"},
                        Case{"half.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -20)),
                             "the finished gear reaches 2.000 mm out of the stock"},
                        Case{"narrow.stl", box(Vec3(-64, -66, -45), Vec3(66, 66, -18)), "mm out of the stock"},
                        Case{"hollow.stl", hollow, "in the teeth of the finished gear"}}) {
    const auto finished = check({"--stock", stl(c.name, c.stock)});
    EXPECT_EQ(finished.exit_code, 3) << c.name;
    EXPECT_NE(finished.err.find(std::string(c.name) + ": error: "), std::string::npos) << finished.err;
    EXPECT_NE(finished.err.find(c.words), std::string::npos) << finished.err;
  }
  // Two halves hold what neither does, and what the body below the teeth needs is not known.
  const std::string left = stl("left.stl", box(Vec3(-66, -66, -24), Vec3(0, 66, -18))),
                    right = stl("right.stl", box(Vec3(0, -66, -24), Vec3(66, 66, -18)));
  EXPECT_EQ(check({"--stock", left, right}).exit_code, 0);
  EXPECT_EQ(check({"--stock", left}).exit_code, 3);
}

TEST_F(SceneTest, AFixtureOfAnotherScaleIsRefused) {
  const auto scaled = [](mesh::TriangleMesh mesh, double by) {
    for (auto& v : mesh.vertices) v *= by;
    return mesh;
  };
  // The clamp that meets the holder, drawn in inches: it would stand in the bore.
  const mesh::TriangleMesh clamp = block(30, 67.5, 75, 1.5, -30, -4);
  const auto inches = check({"--fixture", stl("inches.stl", scaled(clamp, 1 / 25.4))});
  EXPECT_EQ(inches.exit_code, 3);
  EXPECT_NE(inches.err.find("inches.stl: error: "), std::string::npos) << inches.err;
  EXPECT_NE(inches.err.find("in inches it would reach 80.8 mm"), std::string::npos) << inches.err;
  const auto large = check({"--fixture", stl("large.stl", scaled(clamp, 25.4))});
  EXPECT_EQ(large.exit_code, 3);
  EXPECT_NE(large.err.find("mm from the finished gear"), std::string::npos) << large.err;
  // A small part is right where it stands on something.
  const std::string nut = stl("nut.stl", box(Vec3(-5, -5, -12), Vec3(5, 5, -5))),
                    arbor = stl("arbor.stl", box(Vec3(-4, -4, -60), Vec3(4, 4, -3)));
  EXPECT_EQ(check({"--fixture", nut}).exit_code, 3);
  EXPECT_EQ(check({"--fixture", nut, arbor}).exit_code, 0);
}

// No tool comes near to what lies within a tooth: nothing else would find it.
TEST_F(SceneTest, AFixtureInATooth) {
  const std::string core = stl("core.stl", box(Vec3(61.6, -0.3, -20), Vec3(62.8, 0.3, -19.2)));
  const std::string plate = stl("plate.stl", box(Vec3(-80, -80, -60), Vec3(80, 80, -40)));
  const auto finished = check({"--fixture", plate, "--fixture", core});
  EXPECT_EQ(finished.exit_code, 3) << finished.err;
  EXPECT_NE(finished.err.find("core.stl: error: the fixture lies in the teeth of the finished gear at"),
            std::string::npos)
      << finished.err;
}

TEST_F(SceneTest, MeshesShowTheirBoxAndDistance) {
  const auto gear = mesh::load_mesh(*dir_ / "run/gear.stl");
  ASSERT_TRUE(gear);
  double low = 0;
  for (const auto& v : gear->vertices) low = std::min(low, v.z());
  const std::string plate = stl("plate.stl", box(Vec3(-80, -81, -60), Vec3(80, 82, -40)));
  const std::string blank = stl("blank.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -18)));
  const auto finished = check({"--fixture", plate, "--stock", blank});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const Json& mesh = report_["fixture"]["meshes"][0];
  EXPECT_EQ(mesh["file"], plate);
  EXPECT_EQ(mesh["low"], Json({-80, -81, -60}));
  EXPECT_EQ(mesh["high"], Json({80, 82, -40}));
  EXPECT_NEAR(mesh["to_gear"].get<double>(), low + 40, 0.02);
  EXPECT_NEAR(report_["stock"]["meshes"][0]["to_gear"].get<double>(), 0, 1e-3) << "the tips lie in its top";
  EXPECT_NE(finished.out.find("X -80 to 80, Y -81 to 82, Z -60 to -40 mm"), std::string::npos) << finished.out;
  EXPECT_NE(file_text(*dir_ / "check/report.html").find("id=\"scene\""), std::string::npos);
}

// The machinist sees them on paper, whatever the verdict; the sheet of the run, which knows more, stays as it is.
TEST_F(SceneTest, SheetShowsBoxAndDistanceOfEveryMesh) {
  const std::string plate = stl("plate.stl", box(Vec3(-80, -81, -60), Vec3(80, 82, -40)));
  const std::string blank = stl("blank.stl", box(Vec3(-66, -66, -45), Vec3(66, 66, -18)));
  const std::string clamp = stl("clamp.stl", block(0, 67.5, 75, 1.5, -30, -4));
  const std::string out = *dir_ / "same";
  ASSERT_EQ(run_program({"run", job_, "--out", out, "--quiet"}).exit_code, 0);
  const std::string made = file_text(out + "/setup.html");
  struct Case {
    std::vector<std::string> options, says, says_not;
    int exit_code;
  };
  // Long paths break, and do not push the numbers off the paper.
  const std::string plate_row = "<td class=w>" + plate +
                                "</td><td class=n>12</td><td class=n>-80 to 80</td><td class=n>-81 to 82</td>"
                                "<td class=n>-60 to -40</td><td class=n>",
                    blank_row = blank +
                                "</td><td class=n>12</td><td class=n>-66 to 66</td><td class=n>-66 to 66</td>"
                                "<td class=n>-45 to -18</td><td class=n>0.000</td>";
  for (const Case& c :
       {Case{{"--fixture", plate, "--stock", blank},
             {plate_row, blank_row, "Verified: ", "The teeth lie within the stock.", "gear origin, machine"},
             {"0 tool changes"},
             0},
        Case{{"--fixture", plate}, {plate_row, "Verified: "}, {"within the stock", blank}, 0},
        Case{{"--fixture", plate, clamp}, {plate_row, clamp, "NOT VERIFIED", "fixture: holder"}, {}, 1},
        Case{{}, {"Verified: "}, {"Stock and fixture"}, 0}}) {
    std::vector<std::string> words = {"check", job_, out + "/program.ngc", "--out", out, "--json"};
    words.insert(words.end(), c.options.begin(), c.options.end());
    const auto finished = run_program(words);
    ASSERT_EQ(finished.exit_code, c.exit_code) << finished.err;
    const std::string sheet = file_text(out + "/setup_check.html");
    for (const std::string& text : c.says) EXPECT_NE(sheet.find(text), std::string::npos) << text;
    for (const std::string& text : c.says_not) EXPECT_EQ(sheet.find(text), std::string::npos) << text;
    EXPECT_NE(finished.out.find("\"setup_check.html\""), std::string::npos);
    EXPECT_EQ(file_text(out + "/setup.html"), made);
    const bool on_page = file_text(out + "/report.html").find("<td class=\"w\">" + plate) != std::string::npos;
    EXPECT_EQ(on_page, !c.options.empty());
  }
}

TEST_F(SceneTest, BadFilesAreRefusedWithTheirPlace) {
  for (const char* option : {"--fixture", "--stock"}) expect_bad_files_refused(option);
  // Inches taken for millimetres: a stock smaller than the gear.
  const auto inches = check({"--stock", stl("inches.stl", box(Vec3(-2.6, -2.6, -1.8), Vec3(2.6, 2.6, -0.7)))});
  EXPECT_EQ(inches.exit_code, 3);
  EXPECT_NE(inches.err.find("inches"), std::string::npos) << inches.err;
  const auto metres = check({"--fixture", stl("metres.stl", box(Vec3(-0.08, -0.08, -0.06), Vec3(0.08, 0.08, -0.04)))});
  EXPECT_EQ(metres.exit_code, 3);
}

}  // namespace
}  // namespace toothpath::test
