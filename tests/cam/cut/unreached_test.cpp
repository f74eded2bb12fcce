// Surface that the finishing ball does not reach: the largest ball that reaches everything against dense pairs of
// points, and what is told of the surface that was left.
#include "cam/cut/unreached.h"

#include "cam/cut/cut_surface.h"
#include "geometry/face_gear/part.h"
#include "geometry/face_gear/shaper.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"

namespace toothpath {
namespace {

struct DensePoint {
  Vec3 p, n;
};

std::vector<DensePoint> points_of(const test::BruteForceGearSolid& solid, int zone, int rows, int columns,
                                  bool normals) {
  std::vector<DensePoint> out;
  for (int patch = 0; patch < tooth_space::kPieces; ++patch)
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        // The normals are differences of points on both sides.
        const double inside = normals ? 0.001 : 0, x = std::clamp(double(i) / (rows - 1), inside, 1 - inside),
                     y = std::clamp(double(j) / (columns - 1), inside, 1 - inside);
        out.push_back({solid.point(zone, patch, x, y), normals ? solid.normal(zone, patch, x, y) : Vec3(Vec3::Zero())});
      }
  return out;
}

/// The ball through p in its normal that also passes through q, least over all pairs: no ball above it touches p and
/// stays out of the material.
double least_ball_of_pairs(const face_gear::FaceGear& gear, double most) {
  const test::BruteForceGearSolid solid(gear);
  double least = most;
  for (int zone = 0; zone < int(gear.rings().size()); ++zone) {
    const auto all = points_of(solid, zone, 160, 81, false);
    for (const auto& at : points_of(solid, zone, 24, 9, true))
      for (const auto& q : all) {
        const Vec3 across = q.p - at.p;
        const double ahead = across.dot(at.n), length2 = across.squaredNorm();
        if (length2 < 0.01 * least * least || ahead <= 0) continue;  // too near: the normals are differences
        least = std::min(least, length2 / (2 * ahead));
      }
  }
  return least;
}

class LargestBallOf : public testing::TestWithParam<std::string> {};

TEST_P(LargestBallOf, AgreesWithDensePairs) {
  const face_gear::FaceGear gear = test::made(test::gear_named(GetParam()));
  const double most = gear.parameters().module_mm;
  const analytic::GearDistance part(face_gear::part_of(gear), most);
  const auto ball = cut::largest_reaching_ball(part, most);
  const double pairs = least_ball_of_pairs(gear, most);
  EXPECT_LE(ball.radius_mm, pairs * 1.001);
  EXPECT_GE(ball.radius_mm, pairs * 0.98);
}

// A ball of that size touches everything; one that is larger by a twentieth does not.
TEST_P(LargestBallOf, TouchesEverythingAndALargerOneDoesNot) {
  const face_gear::FaceGear gear = test::made(test::gear_named(GetParam()));
  const double most = gear.parameters().module_mm;
  const analytic::GearDistance part(face_gear::part_of(gear), most);
  const double R = cut::largest_reaching_ball(part, most).radius_mm;
  const test::BruteForceGearSolid solid(gear);
  for (const double radius : {R, 1.05 * R}) {
    double deepest = 0;
    for (int zone = 0; zone < part.zones(); ++zone)
      for (const auto& at : points_of(solid, zone, 30, 21, true)) {
        const auto q = part.nearest(at.p + radius * at.n, radius);
        if (q.exact) deepest = std::max(deepest, radius - q.distance);
      }
    if (radius == R) EXPECT_LT(deepest, 1e-4);
    else EXPECT_GT(deepest, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, LargestBallOf, testing::Values("spur", "offset", "conical", "dhfg"),
                         [](const auto& c) { return c.param; });

TEST(LargestBall, IsNotLookedForAboveTheOneThatFits) {
  const face_gear::FaceGear gear = test::made(test::small_spur());
  const analytic::GearDistance part(face_gear::part_of(gear), 1);
  EXPECT_DOUBLE_EQ(cut::largest_reaching_ball(part, 0.3).radius_mm, 0.3);
}

TEST(ConcaveCurvature, OfASaddleAndABall) {
  tooth_space::PatchPoint q;  // unit tangents along x and y, normal along z
  q.pu = Vec3::UnitX();
  q.pv = Vec3::UnitY();
  q.n = Vec3::UnitZ();
  q.nu = -4 * q.pu;
  q.nv = 2 * q.pv;
  EXPECT_DOUBLE_EQ(cut::concave_curvature(q), 4);
  q.nu = 3 * q.pu;
  EXPECT_DOUBLE_EQ(cut::concave_curvature(q), 0);
  // The same saddle in skew parameters.
  q.pu = Vec3(1, 1, 0);
  q.pv = Vec3(0, 2, 0);
  q.nu = Vec3(-4, 2, 0);
  q.nv = Vec3(0, 4, 0);
  EXPECT_NEAR(cut::concave_curvature(q), 4, 1e-12);
}

cut::CutSurface surface(const test::PlannedJob& job) {
  return cut::measure_cut_surface(*job.part, job.motions(), job.operations, job.tools);
}

TEST(Unreached, AWideBallIsTold) {
  const auto& job = test::job_named("spur wide");
  const auto u = surface(job).unreached;
  EXPECT_TRUE(u.left());
  EXPECT_DOUBLE_EQ(u.ball_mm, 1.6);
  EXPECT_DOUBLE_EQ(u.limit_mm, 0.02 + 0.002 + proof::kBallMargin);
  EXPECT_GT(u.height_mm, u.limit_mm);
  EXPECT_GE(u.height_mm, u.max_height_mm);
  EXPECT_GT(u.share, 0.02);
  EXPECT_LT(u.share, 0.5);
  EXPECT_NEAR(u.largest_ball_mm, 2 * cut::largest_reaching_ball(*job.part, 0.8).radius_mm, 1e-12);
  EXPECT_LT(u.largest_ball_mm, 1.6);
  EXPECT_FALSE(u.active) << u.active->height_mm;
}

TEST(Unreached, NothingIsToldWhereTheBallFitsOrNothingFinishes) {
  const auto& job = test::job_named("spur");
  const auto u = surface(job).unreached;
  EXPECT_FALSE(u.left());
  EXPECT_EQ(u.share, 0);
  EXPECT_EQ(u.largest_ball_mm, 0);
  auto roughed = job.operations;
  roughed.resize(1);
  const auto r = cut::measure_cut_surface(*job.part, job.motions(), roughed, job.tools).unreached;
  EXPECT_FALSE(r.left());
  EXPECT_EQ(r.ball_mm, 0);
}

// The active flank ends where a pinion equal to the shaper ends: a ball that stops above that is named with the place,
// one that stops below it (`AWideBallIsTold`) is not.
TEST(Unreached, TheActiveFlankIsNamed) {
  const auto job =
      test::planned(test::small_spur(), {test::ball_mill(2.2, 6, 2.1, 16, 10)}, {test::finishing(0, 0.02, 0.002)});
  const auto u = surface(job).unreached;
  ASSERT_TRUE(u.active);
  EXPECT_GT(u.active->height_mm, u.limit_mm);
  EXPECT_LE(u.active->height_mm, u.height_mm);
  const int side = flank_side(u.active->patch);
  EXPECT_NE(side, 0);
  const auto c = face_gear::invert_flank(job.gear.rings()[0].surface, side, u.active->radius_mm, u.active->z_mm, {});
  ASSERT_TRUE(c);
  EXPECT_LE(c->theta, face_gear::active_roll_parameter(job.gear.parameters(), 0) + 1e-9);
}

}  // namespace
}  // namespace toothpath
