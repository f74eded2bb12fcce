// Stress at the roots of bevel pairs: linear in the forces, in the fillet, of the size that a beam has.
#include "geometry/loaded_bevel/bevel_root_stress.h"

#include <gtest/gtest.h>

#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

loaded::LoadedCycle cycle_of(const loaded_bevel::LoadedBevelPair& pair, double torque_Nm, int positions) {
  loaded::Load load;
  load.torque_nmm = torque_Nm * 1000, load.positions = positions;
  auto cycle = loaded_bevel::loaded_cycle(pair, load);
  if (!cycle) throw std::invalid_argument(cycle.error().message);
  return std::move(cycle).value();
}
elastic::SectorPlan graded_plan() {
  elastic::SectorPlan plan;
  plan.across = 4, plan.flank = 4, plan.fillet = 4, plan.face = 5, plan.grading = 2, plan.rim_mm = 20;
  return plan;
}

TEST(BevelRootStress, IsLinearInTheForcesAndLiesInTheFillet) {
  for (const auto* gears : {&single_gears(), &herringbone_gears()}) {
    const auto pair = pair_of(*gears, -1, coarse_bodies());
    const auto cycle = cycle_of(pair, 200, 2);
    auto twice = cycle;
    for (auto& p : twice.positions)
      for (auto& s : p.segments) s.force *= 2;
    for (std::size_t half = 0; half < pair.halves.size(); ++half)
      for (const bool on_wheel : {true, false}) {
        const auto body = loaded_bevel::root_body(pair, half, on_wheel, graded_plan());
        ASSERT_TRUE(body) << body.error().message;
        const int ring = static_cast<int>(half);
        const auto once = loaded::most_stressed(*body, ring, cycle), more = loaded::most_stressed(*body, ring, twice);
        EXPECT_GT(once.stress, 5);
        EXPECT_NEAR(more.stress, 2 * once.stress, 1e-9 * once.stress);
        EXPECT_EQ(more.tooth, once.tooth);
        const auto& gear = on_wheel ? gears->second : gears->first;
        EXPECT_GT(once.face, gear.halves()[half].ell_from - 1e-6);
        EXPECT_LT(once.face, gear.halves()[half].ell_to + 1e-6);
        EXPECT_GT(once.height, -gear.parameters().dedendum_mm - 1e-6);
        EXPECT_LT(once.height, -gear.parameters().dedendum_mm + gear.cutter_data().tip_radius_mm + 1e-6);
      }
  }
}

/// The tooth that carries is the one that is stressed; its neighbours far less, on either side of the pinion that
/// counts backwards.
TEST(BevelRootStress, FollowsTheTeeth) {
  const auto pair = single_pair(1, coarse_bodies());
  auto cycle = cycle_of(pair, 200, 1);
  for (const bool on_wheel : {true, false}) {
    const auto body = loaded_bevel::root_body(pair, 0, on_wheel, graded_plan());
    ASSERT_TRUE(body) << body.error().message;
    // Two teeth with the same force: the second one presses on the neighbour that its own turn brings.
    loaded::PressedSegment one = cycle.positions[0].segments[0];
    one.force = 1000, one.place.tooth = 0;
    loaded::LoadedCycle alone;
    alone.positions.resize(1);
    alone.positions[0].segments = {one};
    const double own = loaded::most_stressed(*body, 0, alone).stress;
    loaded::PressedSegment next = one;
    next.force = 1e-9, next.place.tooth = 1;
    alone.positions[0].segments = {one, next};
    const auto with_next = loaded::most_stressed(*body, 0, alone);
    EXPECT_NEAR(with_next.stress, own, 1e-6 * own);
    EXPECT_EQ(with_next.tooth, 0);
    // What a force leaves in the neighbour ahead on the wheel it leaves in the one behind on the pinion.
    const auto left_in = [&](int tooth) {
      loaded::LoadedCycle only = alone;
      only.positions[0].segments[1].place.tooth = tooth;
      double most = -1e300;
      loaded::RootBody turned = *body;
      const int offset = tooth * turned.next + turned.stress.reach;
      const auto weights =
          on_wheel ? turned.bricks.weights(one.place.r, one.place.z) : turned.bricks.weights(one.place.Z, one.place.R);
      Eigen::VectorXd force = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(turned.bricks.sector.stations.size()));
      for (std::size_t k = 0; k < 4; ++k) force(weights.station[k]) += weights.weight[k] * one.force;
      const Eigen::VectorXd sum = turned.stress.at_offset[static_cast<std::size_t>(offset)] * force;
      for (std::size_t n = 0; n < turned.nodes.size(); ++n)
        most = std::max(most, elastic::largest_principal(sum.segment<6>(static_cast<Eigen::Index>(6 * n))));
      return most;
    };
    EXPECT_NEAR(left_in(0), own, 1e-9 * own);
    EXPECT_LT(left_in(1), 0.5 * own);
    EXPECT_LT(left_in(-1), 0.5 * own);
    EXPECT_NE(left_in(1), left_in(-1)) << "a fillet is loaded on one side";
  }
}

/// A force along the tip of the wheel's tooth, even over the face. Teeth of one height taper, so the small end is bent
/// most: the beam of its chord at the end of the straight gives the nominal stress there.
TEST(BevelRootStress, IsThatOfABeamTimesItsNotch) {
  const auto pair = single_pair(1, coarse_bodies());
  const auto body = loaded_bevel::root_body(pair, 0, true, graded_plan());
  ASSERT_TRUE(body) << body.error().message;
  const auto& wheel = pair.pair.wheel();
  const auto& half = wheel.halves()[0];
  const double width = half.ell_to - half.ell_from, tip = wheel.parameters().addendum_mm;
  loaded::LoadedCycle cycle;
  cycle.positions.resize(1);
  for (int k = 0; k < 20; ++k) {
    loaded::PressedSegment s;
    s.place.r = half.ell_from + width * (k + 0.5) / 20, s.place.z = tip;
    s.force = 1000.0 / 20;
    cycle.positions[0].segments.push_back(s);
  }
  const double ell = half.ell_from, foot = body->bricks.foot.front();
  const auto low = bevel_gear::bevel_inverse(half.wall(-1), ell, foot),
             high = bevel_gear::bevel_inverse(half.wall(1), ell, foot);
  ASSERT_TRUE(low && high);
  const double cos_beta = std::sqrt(ell / wheel.R_0()), of_middle = std::sqrt(wheel.R_m() / wheel.R_0()),
               chord = wrapped(high->azimuth - low->azimuth + wheel.pitch()) * ell * wheel.sin_delta() * cos_beta,
               nominal = 6 * 1000 * std::cos(radians(20)) * (tip - foot) / (width / of_middle * chord * chord);
  const auto found = loaded::most_stressed(*body, 0, cycle);
  EXPECT_GT(found.stress, 1.0 * nominal);
  EXPECT_LT(found.stress, 2.2 * nominal);
  EXPECT_LT(found.face, wheel.R_m()) << "towards the small end";
}

TEST(BevelRootStress, TwoMeshesTellTheirError) {
  const auto pair = single_pair(-1, coarse_bodies());
  const auto found = loaded_bevel::root_stress(pair, cycle_of(pair, 200, 2));
  ASSERT_TRUE(found) << found.error().message;
  for (const auto& [place, error] : {std::pair(found->gear, found->gear_error), {found->pinion, found->pinion_error}}) {
    EXPECT_GT(place.stress, 20);
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.1 * place.stress);
  }
}

TEST(BevelRootStress, ARimThatFoldsIsRefusedWithItsBody) {
  const auto pair = single_pair(1, coarse_bodies());
  auto plan = graded_plan();
  plan.rim_mm = 500;
  const auto body = loaded_bevel::root_body(pair, 0, false, plan);
  ASSERT_FALSE(body);
  EXPECT_NE(body.error().message.find("half 0 of the pinion: rim = 500 mm"), std::string::npos) << body.error().message;
}

}  // namespace
}  // namespace toothpath::test
