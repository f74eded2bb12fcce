// Stress at the roots of a loaded pair: linear in the forces, at the fillet, of the size that a beam has.
#include "geometry/loaded/root_stress.h"

#include <gtest/gtest.h>

#include "geometry/face_gear/limits.h"
#include "tests/geometry/loaded/spur_pair.h"

namespace toothpath::test {
namespace {

loaded::LoadedCycle cycle_of(const loaded::LoadedPair& pair, double torque_Nm, int positions) {
  loaded::Load load;
  load.torque_nmm = torque_Nm * 1000, load.positions = positions;
  auto cycle = loaded::loaded_cycle(pair, load);
  if (!cycle) throw std::invalid_argument(cycle.error().message);
  return std::move(cycle).value();
}
elastic::SectorPlan coarse_plan() {
  elastic::SectorPlan plan;
  plan.across = 3, plan.flank = 3, plan.fillet = 3, plan.face = 4, plan.grading = 2, plan.rim_mm = 10;
  return plan;
}

TEST(RootStress, IsLinearInTheForcesAndLiesInTheFillet) {
  const loaded::LoadedPair pair = spur_pair();
  const loaded::PairRing& ring = pair.rings[0];
  const auto cycle = cycle_of(pair, 50, 3);
  auto twice = cycle;
  for (auto& p : twice.positions)
    for (auto& s : p.segments) s.force *= 2;
  for (const bool on_gear : {true, false}) {
    const auto body = loaded::root_body(pair, ring, on_gear, coarse_plan());
    ASSERT_TRUE(body) << body.error().message;
    const auto once = loaded::most_stressed(*body, 0, cycle), more = loaded::most_stressed(*body, 0, twice);
    EXPECT_GT(once.stress, 0);
    EXPECT_NEAR(more.stress, 2 * once.stress, 1e-9 * once.stress);
    EXPECT_EQ(more.tooth, once.tooth);
    const auto& f = ring.surface;
    if (on_gear) {
      EXPECT_GT(once.face, kSpurInner - 1e-6);
      EXPECT_LT(once.face, kSpurOuter + 1e-6);
      EXPECT_LT(once.height, *face_gear::fillet_line_height(f, 1, once.face));
      EXPECT_GT(once.height, *face_gear::root_height(f, once.face));
    } else {
      EXPECT_GT(once.height, f.shaper.r_p - f.shaper.h_f);
      EXPECT_LT(once.height, f.shaper.r_b + 0.5);
    }
  }
}

TEST(RootStress, IsThatOfABeamTimesItsNotch) {
  // The whole load on the tip of one tooth of the gear, spread along the face: Lewis' parabola of a beam with the foot
  // and the height of the tooth gives the nominal stress; a fillet of 0.3 of the module adds a third to two thirds.
  const loaded::LoadedPair pair = spur_pair();
  const loaded::PairRing& ring = pair.rings[0];
  const auto body = loaded::root_body(pair, ring, false, coarse_plan());
  ASSERT_TRUE(body);
  const double R = ring.surface.shaper.r_p + ring.surface.shaper.h_a, width = ring.bounds.most_Z - ring.bounds.least_Z;
  loaded::LoadedCycle cycle;
  cycle.positions.resize(1);
  for (int k = 0; k < 20; ++k) {
    loaded::PressedSegment s;
    s.place.R = R, s.place.Z = ring.bounds.least_Z + width * (k + 0.5) / 20;
    s.force = 1000.0 / 20;
    cycle.positions[0].segments.push_back(s);
  }
  const auto pinion = contact::make_pinion(ring.surface, 20);
  const auto profile = loaded::pinion_profile(pinion, ring.surface.shaper.h_f, 0.48);
  // The tangential part at the tip bends a foot of the chord at the fillet's lower third.
  const double foot_R = profile.r_f + profile.fillet * (1 - std::cos(kPi / 6)), half = profile.centre - 0.0,
               chord = 2 * (profile.r_f + profile.fillet) * std::sin(half) - 2 * profile.fillet * std::cos(kPi / 6),
               pressed = std::acos(profile.r_b / R), thin = profile.half_angle(R),
               tangential = 1000 * std::cos(pressed - thin), arm = R - foot_R;
  const double nominal = 6 * tangential * arm / (width * chord * chord);
  const double found = loaded::most_stressed(*body, 0, cycle).stress;
  EXPECT_GT(found, 1.0 * nominal);
  EXPECT_LT(found, 2.2 * nominal);
}

TEST(RootStress, TwoMeshesTellTheirError) {
  const loaded::LoadedPair pair = spur_pair();
  const auto found = loaded::root_stress(pair, cycle_of(pair, 50, 2));
  ASSERT_TRUE(found) << found.error().message;
  for (const auto& [place, error] : {std::pair(found->gear, found->gear_error), {found->pinion, found->pinion_error}}) {
    EXPECT_GT(place.stress, 20);
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.1 * place.stress);
  }
}

TEST(RootStress, SharpTipsOfTheShaperAreRefused) {
  const loaded::LoadedPair pair = spur_pair(0);
  const auto found = loaded::root_stress(pair, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message,
            "shaper_tip_radius = 0 mm is not above 0: a fillet without a radius has no finite "
            "stress");
}

}  // namespace
}  // namespace toothpath::test
