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
