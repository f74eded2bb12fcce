// Friction of bevel pairs as a bound: sliding against finite differences of the two rotations, power, size.
#include "geometry/loaded_bevel/bevel_friction.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

loaded_bevel::BevelPairOptions misaligned_bodies() {
  auto options = coarse_bodies();
  options.moved = {2e-4, 0.03, 0.02, -0.04};
  return options;
}
loaded::LoadedPosition position_of(const loaded_bevel::LoadedBevelPair& pair, double phase) {
  loaded::Load load;
  load.torque_nmm = 200e3;
  auto found = loaded_bevel::loaded_position(pair, load, pair.pair.pinion().pitch() * phase);
  if (!found) throw std::invalid_argument(found.error().message);
  return std::move(found).value();
}

/// A point that rides on the pinion less one that rides on the wheel, both there now.
TEST(BevelFriction, SlidingIsTheDifferenceOfTheTwoRotations) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto pair = single_pair(1, misaligned_bodies());
  const auto& rolled = pair.pair;
  const auto turning = loaded_bevel::turning_of(pair);
  for (int k = 0; k < 50; ++k) {
    const double phi_1 = unit(random), phi_2 = -phi_1 / rolled.ratio(), step = 1e-5;
    const Vec3 point(60 * unit(random), 60 * unit(random), 100 + 20 * unit(random));
    const auto on_wheel = [&](double at) { return rolled.to_pinion(point, at); };
    const auto on_pinion = [&](const Vec3& p, double by) -> Vec3 { return Eigen::AngleAxisd(by, Vec3::UnitZ()) * p; };
    const Vec3 here = on_wheel(phi_2),
               wheel = (on_wheel(phi_2 - step / rolled.ratio()) - on_wheel(phi_2 + step / rolled.ratio())) / (2 * step),
               pinion = (on_pinion(here, step) - on_pinion(here, -step)) / (2 * step);
    EXPECT_LT((loaded::sliding(turning, here) - (pinion - wheel)).norm(), 1e-6);
  }
}

/// Flanks that touch do not part: they slide in their tangent plane, but for the mismatch of the pair.
TEST(BevelFriction, PlacesSlideInTheirTangentPlane) {
  for (const int sigma : {1, -1}) {
    const auto pair = single_pair(sigma, coarse_bodies());
    const auto turning = loaded_bevel::turning_of(pair);
    const auto& pinion = pair.pair.pinion();
    for (const double phase : {0.0, 0.3, 0.8})
      for (const auto& s : position_of(pair, phase).segments) {
        const Vec3 v = loaded::sliding(turning, s.place.point);
        EXPECT_LT(std::abs(v.dot(s.place.normal)), 0.02 * pinion.R_m() * pinion.sin_delta()) << v.norm();
      }
  }
}

/// The power lost at every place, by the torques on both gears and by the sliding.
TEST(BevelFriction, IsTheWorkThatItTakes) {
  const auto pair = single_pair(1, misaligned_bodies());
  const auto turning = loaded_bevel::turning_of(pair);
  const auto p = position_of(pair, 0.4);
  double lost = 0, torque = 0, axial = 0;
  for (const auto& s : p.segments) {
    const Vec3 v = loaded::sliding(turning, s.place.point), on_wheel = v.normalized() * 0.1 * s.force;
    const double of_wheel = (s.place.point - pair.pair.wheel_apex()).cross(on_wheel).dot(pair.pair.wheel_axis()),
                 of_pinion = s.place.point.cross(-on_wheel).z();
    EXPECT_NEAR(of_pinion - of_wheel / pair.pair.ratio(), -0.1 * s.force * v.norm(), 1e-9 * s.force);
    lost += 0.1 * s.force * v.norm(), torque += of_wheel, axial -= on_wheel.z();
  }
  EXPECT_GT(lost, 0);
  const auto f = loaded_bevel::friction_of(pair, p, 0.1);
  EXPECT_NEAR(f.torque_part, torque / p.gear_torque_nmm, 1e-12);
  EXPECT_NEAR(f.axial_n, axial, 1e-9 * std::abs(axial));
}

TEST(BevelFriction, GrowsWithMuAndStaysBelowIt) {
  const auto pair = herringbone_pair(1, coarse_bodies());
  for (const double phase : {0.0, 0.5}) {
    const auto p = position_of(pair, phase);
    double force = 0;
    for (const auto& s : p.segments) force += s.force;
    const auto a = loaded_bevel::friction_of(pair, p, 0.05), b = loaded_bevel::friction_of(pair, p, 0.1);
    EXPECT_NEAR(b.axial_bound_n, 2 * a.axial_bound_n, 1e-12 * force);
    EXPECT_NEAR(b.torque_part, 2 * a.torque_part, 1e-12);
    EXPECT_LE(std::abs(b.axial_n), b.axial_bound_n * (1 + 1e-12));
    EXPECT_LE(b.axial_bound_n, 0.1 * force);
    EXPECT_GT(b.axial_bound_n, 0);
    EXPECT_LE(std::abs(b.torque_part), b.torque_bound * (1 + 1e-12));
    EXPECT_GT(b.torque_bound, 0);
    EXPECT_EQ(loaded_bevel::friction_of(pair, p, 0).axial_bound_n, 0);
  }
}

}  // namespace
}  // namespace toothpath::test
