// `toothpath check` of a bevel gear with meshes of fixture and stock: planted collisions of every body are found, clean
// scenes pass.
#include <gtest/gtest.h>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "cam/finger/milling.h"
#include "tests/app/check_scene.h"

namespace toothpath::test {
namespace {

/// A solid turned about z from a closed outline (r, z), clockwise in that plane.
mesh::TriangleMesh solid_of_revolution(const std::vector<Vec2>& outline, int n = 90) {
  mesh::TriangleMesh mesh;
  const auto m = int(outline.size());
  for (int k = 0; k < n; ++k)
    for (const Vec2& q : outline)
      mesh.vertices.push_back({q.x() * std::cos(2 * M_PI * k / n), q.x() * std::sin(2 * M_PI * k / n), q.y()});
  const auto at = [&](int k, int i) { return std::int32_t((k % n) * m + i % m); };
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < m; ++i) {
      mesh.triangles.push_back({at(k, i), at(k + 1, i + 1), at(k + 1, i)});
      mesh.triangles.push_back({at(k, i), at(k, i + 1), at(k + 1, i + 1)});
    }
  return mesh;
}

// The herringbone pinion of the trunnion sample: 18 teeth, pitch angle 33.7 deg, cone distances 18.45 to 32.45. The
// cutting part of the mill is 2.9 high, the shank has radius 3, the holder (radius 10) begins 25 above the tip.
class BevelScene : public CheckScene {
 protected:
  static void SetUpTestSuite() {
    run_sample("bevel_trunnion.toml");
    auto read = job::read_job_file(job_);
    gear_.emplace(process::make_bevel_gear(read.value()).value());
  }
  /// (r, z) at a cone distance and a height above the pitch cone.
  static Vec2 place(double ell, double height) {
    return {ell * gear_->sin_delta() + height * gear_->cos_delta(),
            ell * gear_->cos_delta() - height * gear_->sin_delta()};
  }
  /// The turned blank with its face cone at a height above the pitch cone.
  static mesh::TriangleMesh blank(double height) {
    const Vec2 front = place(gear_->R_i(), height), back = place(gear_->R_e(), height), foot = place(gear_->R_e(), -4);
    return solid_of_revolution({Vec2(2, front.y()), Vec2(2, foot.y()), foot, back, front});
  }
  /// A cube about a point of the middle of a tooth space, `up` above the root along the tool axis.
  static mesh::TriangleMesh cube(double ell, int tooth, double up, double half) {
    const auto& trace = gear_->halves().back().walls[0].trace;
    const double e = trace.middle(trace.beta(std::min(ell, gear_->R_e()))).e + tooth * gear_->pitch();
    const Vec3 c = gear_->tip(ell, e, up);
    return box(c - Vec3::Constant(half), c + Vec3::Constant(half));
  }
  static inline std::optional<bevel_gear::BevelGear> gear_;
};

TEST_F(BevelScene, WithoutMeshesNothingIsLoaded) { expect_nothing_loaded_without_meshes(); }

TEST_F(BevelScene, CleanFixtureAndStockPass) {
  const std::string plate = stl("plate.stl", box(Vec3(-40, -40, 38), Vec3(40, 40, 50)));
  const std::string turned_blank = stl("blank.stl", blank(gear_->parameters().addendum_mm));
  const auto finished = check({"--fixture", plate, "--stock", turned_blank});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(report_["fixture"]["clear"].get<bool>());
  EXPECT_TRUE(report_["stock"]["clear"].get<bool>());
  EXPECT_NE(finished.out.find("fixture"), std::string::npos);
  EXPECT_GT(report_["fixture"]["motions"].get<int>(), 5000) << "every tooth";
  // The shank begins 0.2 above the tips: that is the gap which the stock shows.
  EXPECT_NEAR(report_["stock"]["clearance"].get<double>(), 0.2, 0.03);
  EXPECT_NE(file_text(*dir_ / "check/report.html"), "");
}

TEST_F(BevelScene, HolderOnlyAndOneToothOnly) {
  // Above the shank of every feed; rapids lift the shank there too.
  const int tooth = 7;
  const auto finished = check({"--fixture", stl("clamp.stl", cube(25.45, tooth, 36, 1))});
  EXPECT_EQ(finished.exit_code, 1);
  const Json& worst = report_["fixture"]["worst"];
  int feeds = 0;
  for (const auto& w : worst) {
    EXPECT_NEAR(w["tooth"].get<int>(), tooth, 1) << "the holder is 20 mm wide, a pitch 16 mm at its height";
    EXPECT_GT(w["line"].get<int>(), 0);
    if (w["rapid"].get<bool>()) continue;
    EXPECT_EQ(w["body"], "holder");
    ++feeds;
  }
  EXPECT_GT(feeds, 0);
  EXPECT_NE(finished.err.find("fixture: "), std::string::npos) << finished.err;
  EXPECT_NE(finished.out.find("holder"), std::string::npos);
}

TEST_F(BevelScene, ProfileOfTheCutterOnlyAndOneToothOnly) {
  // Where the passes run out beyond the large end, as high as the lower half of the profile.
  const int tooth = 4;
  EXPECT_EQ(check({"--fixture", stl("stop.stl", cube(gear_->R_e() + 0.8, tooth, 0.2, 0.51))}).exit_code, 1);
  const Json& worst = report_["fixture"]["worst"];
  ASSERT_FALSE(worst.empty());
  for (const auto& w : worst) {
    EXPECT_EQ(w["body"], "cutter");
    EXPECT_FALSE(w["rapid"].get<bool>());
    EXPECT_EQ(w["tooth"].get<int>(), tooth);
  }
}

TEST_F(BevelScene, TheProfileAndNotACylinderIsJudged) {
  // A thin ring over the teeth at the large end, just outside the tapering profile but inside the largest radius: no
  // pass of this program comes nearer than the taper leaves.
  const bevel_gear::FingerSolid solid(gear_->cutter());
  const double h_f = gear_->parameters().dedendum_mm, low = solid.radius(-h_f + 0.3), wide = solid.largest_radius();
  ASSERT_GT(wide - low, 0.3);
  const double run_out = gear_->R_e() + wide + 1.0;  // the passes end here
  const auto ring = [&](double gap) {
    const double from = run_out + low + gap;
    return solid_of_revolution(
        {place(from, -h_f - 0.6), place(from + 1, -h_f - 0.6), place(from + 1, -h_f + 0.1), place(from, -h_f + 0.1)});
  };
  ASSERT_LT(low + 0.15, wide);
  EXPECT_EQ(check({"--fixture", stl("beside.stl", ring(0.15))}).exit_code, 0);
  EXPECT_LT(report_["fixture"]["clearance"].get<double>(), 0.5);
  EXPECT_EQ(check({"--fixture", stl("into.stl", ring(-0.3))}).exit_code, 1);
  EXPECT_EQ(report_["fixture"]["worst"][0]["body"], "cutter");
}

TEST_F(BevelScene, RapidOnly) {
  // Feeds lift the top of the holder to 72 above the root, rapids to 82.
  EXPECT_EQ(check({"--fixture", stl("bridge.stl", cube(25.45, 0, 77, 2))}).exit_code, 1);
  ASSERT_FALSE(report_["fixture"]["worst"].empty());
  for (const auto& w : report_["fixture"]["worst"]) EXPECT_TRUE(w["rapid"].get<bool>());
}

TEST_F(BevelScene, StockInTheWayOfRapidsAndOfTheShank) {
  // A bar along the tool axis, from above the holder of every feed: only rapids come there.
  mesh::TriangleMesh bar = box(Vec3(-1, -1, 75), Vec3(1, 1, 130));
  const Vec3 u = gear_->axis(0), across = Vec3::UnitY(), along = across.cross(u);
  for (Vec3& v : bar.vertices) v = Vec3(gear_->tip(25.45, 0, 0) + v.x() * along + v.y() * across + v.z() * u);
  const std::string turned_blank = stl("blank.stl", blank(gear_->parameters().addendum_mm));
  EXPECT_EQ(check({"--stock", turned_blank, stl("bar.stl", bar)}).exit_code, 1);
  ASSERT_FALSE(report_["stock"]["worst"].empty());
  for (const auto& w : report_["stock"]["worst"]) {
    EXPECT_TRUE(w["rapid"].get<bool>());
    EXPECT_EQ(w["body"], "holder");
  }
  bool shank = false;
  EXPECT_EQ(check({"--stock", stl("boss.stl", blank(gear_->parameters().addendum_mm + 0.4))}).exit_code, 1);
  for (const auto& w : report_["stock"]["worst"]) {
    EXPECT_EQ(w["body"], "shank");
    EXPECT_FALSE(w["rapid"].get<bool>());
    shank = true;
  }
  EXPECT_TRUE(shank);
}

TEST_F(BevelScene, BadFilesAreRefusedWithTheirPlace) {
  for (const char* option : {"--fixture", "--stock"}) expect_bad_files_refused(option);
  const auto small = check({"--stock", stl("small.stl", box(Vec3(-18, -18, 10), Vec3(18, 18, 30)))});
  EXPECT_EQ(small.exit_code, 3);
  EXPECT_NE(small.err.find("mm out of the stock"), std::string::npos) << small.err;
  // The face cone 1 mm too low: the tips are not there.
  const auto low = check({"--stock", stl("low.stl", blank(gear_->parameters().addendum_mm - 1))});
  EXPECT_EQ(low.exit_code, 3);
  EXPECT_NE(low.err.find("the finished gear reaches 1.0"), std::string::npos) << low.err;
}

}  // namespace
}  // namespace toothpath::test
