// Friction as a bound: sliding is tangential, halves cancel along the axis, nothing beyond mu.
#include "geometry/loaded/friction.h"

#include <gtest/gtest.h>

#include "tests/geometry/loaded/spur_pair.h"
#include "tests/geometry/loaded/trial_gear.h"

namespace toothpath::test {
namespace {

TEST(Friction, PlacesSlideInTheirTangentPlane) {
  const loaded::LoadedPair pair = spur_pair();
  for (const double phase : {0.0, 0.3, 0.8})
    for (const auto& s : spur_position(pair, 50, phase).segments) {
      if (s.place.beyond > 0 || s.place.on_edge) continue;
      EXPECT_NEAR(loaded::sliding(pair, pair.rings[0], s.place.point).dot(s.place.normal), 0, 1e-9);
    }
}

TEST(Friction, IsTheWorkThatItTakes) {
  // The power lost, torque on the pinion and on the gear: M_1 - ratio M_2 = -sum of mu f |v|, at every place.
  const loaded::LoadedPair pair = spur_pair();
  const auto p = spur_position(pair, 50, 0.4);
  const auto& ring = pair.rings[0];
  for (const auto& s : p.segments) {
    if (!(s.force > 0)) continue;
    const Vec3 v = loaded::sliding(pair, ring, s.place.nearest), on_gear = v.normalized() * 0.1 * s.force,
               arm = s.place.nearest - ring.moved.foot;
    const double of_gear = s.place.nearest.cross(on_gear).z(), of_pinion = arm.cross(-on_gear).dot(ring.moved.a);
    EXPECT_NEAR(of_pinion + of_gear * 20.0 / 60, -0.1 * s.force * v.norm(), 1e-9 * s.force);
  }
}

TEST(Friction, GrowsWithMuAndStaysBelowIt) {
  const loaded::LoadedPair pair = spur_pair();
  const auto p = spur_position(pair, 50, 0.4);
  const auto a = loaded::friction_of(pair, p, 0.05), b = loaded::friction_of(pair, p, 0.1);
  const double load = 50e3 / pair.lever;
  EXPECT_NEAR(b.axial_bound_n, 2 * a.axial_bound_n, 1e-12 * load);
  EXPECT_NEAR(b.torque_part, 2 * a.torque_part, 1e-12);
  EXPECT_LE(std::abs(b.axial_n), b.axial_bound_n * (1 + 1e-12));
  EXPECT_LE(b.axial_bound_n, 0.1 * load);
  EXPECT_LE(std::abs(b.torque_part), b.torque_bound * (1 + 1e-12));
  EXPECT_GT(b.torque_bound, 0);
  EXPECT_EQ(loaded::friction_of(pair, p, 0).axial_bound_n, 0);
}

/// Along the axis the flanks slide as fast as the gear crosses it there, whatever the hand: the friction of two halves
/// of opposite hand adds up. What cancels are places before and behind the plane through both axes.
TEST(Friction, OfTwoHalvesAddsUp) {
  loaded::PairOptions options;
  for (auto* body : {&options.gear, &options.pinion})
    body->bricks.across = 3, body->bricks.flank = 4, body->bricks.face = 5;
  const auto pair = loaded::make_loaded_pair(trial_gear(), 1, 30, options);
  ASSERT_TRUE(pair);
  loaded::Load load;
  load.torque_nmm = 532e3;
  load.axial = loaded::PinionAxial::floating;
  for (const double phase : {0.0, 0.4}) {
    const auto p = loaded::loaded_position(*pair, load, 2 * kPi / 30 * phase);
    ASSERT_TRUE(p);
    double halves = 0;
    for (const int ring : {0, 1}) {
      const auto& of = pair->rings[static_cast<std::size_t>(ring)];
      auto half = *p;
      std::erase_if(half.segments, [&](const auto& s) { return s.place.ring != ring; });
      for (const auto& s : half.segments)
        EXPECT_NEAR(loaded::sliding(*pair, of, s.place.point).dot(of.moved.a), s.place.point.y() / 6, 1e-9);
      const double axial = loaded::friction_of(*pair, half, 0.1).axial_n;
      EXPECT_GT(axial * halves, ring == 0 ? -1 : 0) << "of one sign";
      halves += axial;
    }
    const auto both = loaded::friction_of(*pair, *p, 0.1);
    EXPECT_NEAR(both.axial_n, halves, 1e-9 * std::abs(halves));
    EXPECT_GT(std::abs(both.axial_n), 0.001 * 1258);
  }
}

}  // namespace
}  // namespace toothpath::test
