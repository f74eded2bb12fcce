// From a point back to the flank: round trips, the edge of regularity, the eikonal, the exact distance.
#include <gtest/gtest.h>

#include "geometry/face_gear/inverse.h"
#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

std::vector<FaceGearCase> all_cases() {
  auto cases = extreme_cases();
  for (const auto& c : random_cases(4711, 20)) cases.push_back(c);
  return cases;
}

class Inverse : public testing::TestWithParam<FaceGearCase> {};

/// Position -> parameters -> position, from a cold start and from a wrong neighbour.
TEST_P(Inverse, RoundTrip) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const auto samples = trimmed_flank(f, c.module_mm, 7, 6);
  ASSERT_FALSE(samples.empty());
  std::optional<face_gear::FlankCoordinates> neighbour[2];
  for (const auto& at : samples) {
    const Vec3 P = f.flank_housing(at.side, at.theta, at.B);
    const double r = std::hypot(P.x(), P.y());
    auto& last = neighbour[at.side > 0 ? 0 : 1];
    for (const auto& start : {std::optional<face_gear::FlankCoordinates>(), last}) {
      const auto back = face_gear::invert_flank(f, at.side, r, P.z(), start);
      ASSERT_TRUE(back);
      EXPECT_GT(back->J, 0);
      const Vec3 Q = f.flank_housing(at.side, back->theta, back->B);
      EXPECT_NEAR(std::hypot(Q.x(), Q.y()), r, 1e-13 * f.L_p);
      EXPECT_NEAR(Q.z(), P.z(), 1e-13 * f.L_p);
      last = back;
    }
    const auto B = face_gear::flank_B_at_radius(f, at.side, at.theta, r, at.B + 0.01 * at.side);
    ASSERT_TRUE(B);
    EXPECT_NEAR(*B, at.B, 1e-9);
  }
}

/// T4. dTheta/dr = -s n_r/M2, dTheta/dz = -s n_z/M2 and the eikonal equation, by differences of Theta(r, z).
TEST_P(Inverse, AzimuthObeysTheEikonal) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  const double h = 2e-4 * c.module_mm;
  int tried = 0;
  for (const auto& at : trimmed_flank(f, c.module_mm, 4, 4)) {
    const auto q = f.flank(at.side, at.theta, at.B);
    const double r = std::hypot(q.p.x(), q.p.y()), z = q.p.z();
    if (r < limits.inner_limit + 0.3 * c.module_mm) continue;  // third derivatives grow like J^-3
    const auto azimuth = [&](double radius, double height) {
      const auto inv =
          face_gear::invert_flank(f, at.side, radius, height, face_gear::FlankCoordinates{at.theta, at.B, 0});
      return inv ? face_gear::flank_azimuth(f, at.side, *inv) : NAN;
    };
    const double by_r = (azimuth(r + h, z) - azimuth(r - h, z)) / (2 * h);
    const double by_z = (azimuth(r, z + h) - azimuth(r, z - h)) / (2 * h);
    const double n_r = (q.n.x() * q.p.x() + q.n.y() * q.p.y()) / r;
    EXPECT_NEAR(by_r * f.M2, -at.side * n_r, 1e-6);
    EXPECT_NEAR(by_z * f.M2, -at.side * q.n.z(), 1e-6);
    EXPECT_NEAR(f.M2 * f.M2 * (by_r * by_r + by_z * by_z + 1 / (r * r)), 1, 1e-6);
    EXPECT_GT(r, f.M2);
    ++tried;
  }
  EXPECT_GT(tried, 0);
}

/// The distance of a point moved along the normal is the way it was moved; its foot is where it came from. Any tooth
/// pitch away it is another tooth's distance.
TEST_P(Inverse, DistanceAlongTheNormal) {
  const auto& c = GetParam();
  const auto f = c.surface();
  for (const auto& at : trimmed_flank(f, c.module_mm, 4, 4)) {
    const auto q = f.flank(at.side, at.theta, at.B);
    for (const double share : {-0.1, -0.01, 0.003, 0.1}) {
      const double delta = share * c.module_mm;
      const double th =
          at.theta - delta * f.shaper.cos_bb / f.shaper.r_b;  // the parallel surface is this flank, turned
      if (!(f.flank_J(at.side, th, at.B) > 0)) continue;
      const auto d = face_gear::flank_distance(f, at.side, Vec3(q.p + delta * q.n));
      ASSERT_TRUE(d) << c.name << " side " << at.side << " theta " << at.theta << " delta " << delta;
      EXPECT_NEAR(d->distance, delta, 1e-12 * f.L_p);
      const auto foot = f.flank(at.side, d->foot.theta, d->foot.B);
      if (d->foot.J > 1e-3 * f.L_p * c.module_mm) { EXPECT_LT((foot.p - q.p).norm(), 1e-10 * f.L_p); }
    }
  }
}

TEST_P(Inverse, FilletSectionAtARadius) {
  auto c = GetParam();
  c.tip_radius_mm = 0.4 * largest_tip_radius(c.parameters(), c.beta());
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  for (const double t : {0.01, 0.5, 1.0}) {
    const double r = limits.hard_inner_limit * (1 - t) + *limits.land_radius * t;
    const double start = (std::sqrt(r * r - f.E * f.E) + f.shaper.r_a * f.Cg) / f.Sg;
    for (const int side : {1, -1}) {
      for (const double u : {0.1, 0.6, 1.0}) {
        const double A = f.shaper.A_t + u * (f.shaper.A_e - f.shaper.A_t);
        const auto Z = face_gear::fillet_Z_at_radius(f, side, A, r, start);
        ASSERT_TRUE(Z);
        const auto q = f.fillet(side, A, *Z);
        EXPECT_NEAR(std::hypot(q.p.x(), q.p.y()), r, 1e-12 * r);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, Inverse, testing::ValuesIn(all_cases()), name_of_case);

/// T16. Towards the cusp the parameters become uncertain, the position does not.
TEST(FaceGearInverse, PositionStaysExactTowardsTheCusp) {
  const auto f = case_named("offset_15").surface();
  const auto limits = face_gear::zone_limits(f, 3);
  const auto& flank = limits.flanks[1];
  ASSERT_TRUE(flank.undercut_B);
  const double J_printed[] = {46, 0.47, 4.7e-4, 4.7e-7};
  int row = 0;
  for (const double gap : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const double r = *flank.undercut_radius + gap;
    const auto B = face_gear::flank_B_at_radius(f, -1, f.shaper.theta_t, r, *flank.undercut_B - 0.02);
    ASSERT_TRUE(B);
    const Vec3 P = f.flank_housing(-1, f.shaper.theta_t, *B);
    EXPECT_NEAR(f.flank_J(-1, f.shaper.theta_t, *B) / J_printed[row++], 1, 0.02);
    const auto back = face_gear::invert_flank(f, -1, std::hypot(P.x(), P.y()), P.z());
    ASSERT_TRUE(back) << gap;
    const Vec3 Q = f.flank_housing(-1, back->theta, back->B);
    EXPECT_NEAR(std::hypot(Q.x(), Q.y()), std::hypot(P.x(), P.y()), 1e-12);
    EXPECT_NEAR(Q.z(), P.z(), 1e-12);
    EXPECT_NEAR(face_gear::flank_azimuth(f, -1, *back), face_gear::flank_azimuth(f, -1, {f.shaper.theta_t, *B, 0}),
                1e-10 / r);
  }
}

TEST(FaceGearInverse, NoAnswerWhereThereIsNoFlank) {
  const auto f = case_named("offset_15").surface();
  EXPECT_FALSE(face_gear::invert_flank(f, 1, f.M2 * 0.999, -37));
  EXPECT_FALSE(face_gear::invert_flank(f, 1, 0, -37));
  EXPECT_FALSE(face_gear::invert_flank(f, -1, 124.2, -40));  // below the singular edge
  EXPECT_FALSE(face_gear::invert_flank(f, 1, NAN, -37));
}

}  // namespace
}  // namespace toothpath::test
