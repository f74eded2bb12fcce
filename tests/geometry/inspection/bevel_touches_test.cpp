// Touches of bevel gears: ball and stem meet nothing but their wall, and a gear that stands anywhere is found.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "geometry/inspection/bevel_touches.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/random.h"
#include "tests/support/touching_ball.h"

namespace toothpath {
namespace {

using inspection::Touch;
using inspection::TouchedBevelGear;
using inspection::TouchOptions;
using inspection::TouchResult;

struct BevelTrial {
  const char* name;
  bevel_gear::BevelGear gear;
  TouchOptions options;
};

std::vector<BevelTrial> bevel_trials() {
  return {{"single pinion", bevel_test::made(bevel_test::w1(), bevel_test::pinion_mill()), {2.0, 0, 1, 0.05, 4}},
          {"single wheel", bevel_test::made(bevel_test::w2(), bevel_test::wheel_mill()), {1.5, 0.1, 1, 0.05, 3}},
          {"herringbone pinion", bevel_test::made(bevel_test::w3(), bevel_test::pinion_mill()), {2.0, 0, 1, 0.05, 4}},
          {"herringbone wheel", bevel_test::made(bevel_test::w4(), bevel_test::wheel_mill()), {1.0, 0.05, 1, 0.03, 5}}};
}

/// Places of a ball, or of a stem above it, that looks along `up`.
std::vector<Vec3> body_at(const Vec3& centre, const Vec3& up, double ball, double stem, double way) {
  std::vector<Vec3> out;
  const Vec3 across = up.unitOrthogonal(), third = up.cross(across);
  const auto around = [&](double angle) -> Vec3 { return std::cos(angle) * across + std::sin(angle) * third; };
  for (int k = 0; k < 24; ++k) {
    for (int i = -11; i <= 11; ++i) {
      const double t = i * kPi / 24;
      out.push_back(centre + ball * (std::cos(t) * around(k * kPi / 12) + std::sin(t) * up));
    }
    for (int i = 1; i <= 12; ++i) out.push_back(centre + stem * around(k * kPi / 12) + way * i / 12 * up);
  }
  return out;
}

/// The greatest depth of a body in what the brute force leaves of the blank.
double deepest(const test::BruteForceBevelGear& left, const bevel_gear::BevelGear& gear, int space,
               const std::vector<Vec3>& body) {
  double out = -INFINITY;
  for (const Vec3& x : body) {
    const Vec3 q = turned(x, -space * gear.pitch());
    if (left.height_of(q) < gear.parameters().addendum_mm) out = std::max(out, left.clearance(q));
  }
  return out;
}

TEST(BevelTouches, TheBallAndItsStemMeetNothingButTheirWall) {
  for (const auto& [name, gear, options] : bevel_trials()) {
    const TouchedBevelGear part(std::make_shared<bevel_gear::BevelPart>(gear));
    const auto plan = inspection::plan_touches(part, options);
    ASSERT_TRUE(plan) << name << ": " << plan.error().message;
    EXPECT_EQ(plan->touches.size(), std::size_t(options.spaces) * 4) << name;
    EXPECT_GE(plan->gap_mm, options.least_gap_mm) << name;
    const auto& mill = gear.cutter_data();
    const test::BruteForceBevelGear left(
        gear.parameters(), {mill.module_mm, mill.tip_radius_mm, mill.rack_depth_mm, mill.profile_height_mm});
    // With its gap the ball meets nothing on the way down; the bare ball touches its wall and goes no deeper.
    const double ball = 0.5 * options.ball_diameter_mm + options.allowance_mm, wide = ball + options.least_gap_mm,
                 stem = 0.8 * 0.5 * options.ball_diameter_mm + options.allowance_mm;
    double touched = -INFINITY;
    for (const Touch& t : plan->touches) {
      for (int k = 0; k <= 4; ++k) {
        const Vec3 at = t.start() + 0.25 * k * part.below_tops(t, t.start()) * t.up;
        EXPECT_LT(deepest(left, gear, t.space, body_at(at, t.up, wide, stem, part.below_tops(t, at))), 1e-6)
            << name << " " << t.number << " " << k;
        const Vec3 near = t.centre + 0.25 * k * t.approach_mm * t.normal;
        EXPECT_LT(deepest(left, gear, t.space, body_at(near, t.up, ball, stem, part.below_tops(t, near))), 2e-4)
            << name << " " << t.number << " " << k;
      }
      const Vec3 pressed = t.centre - 0.02 * t.normal;
      touched = std::max(touched, deepest(left, gear, t.space, {pressed - ball * t.normal}));
      EXPECT_GT(deepest(left, gear, t.space, {pressed - ball * t.normal}), 0.005) << name << " " << t.number;
      EXPECT_NEAR(*part.distance(t, t.centre), ball, 1e-9) << name;
      // Somewhere else the distance is the least way to the wall: a plain search.
      const Vec3 x = t.centre + 0.3 * t.up + 0.2 * t.normal.cross(t.up);
      const auto& wall = gear.halves()[std::size_t(t.zone)].wall(t.side);
      const Vec3 q = turned(x, -t.space * gear.pitch());
      const auto from = bevel_inverse(wall, left.ell_of(q), left.height_of(q));
      ASSERT_TRUE(from);
      double least = INFINITY;
      for (int i = -60; i <= 60; ++i)
        for (int j = -60; j <= 60; ++j)
          least = std::min(least, (wall.point(from->beta + i * 5e-4, from->p + j * 0.03).p - q).norm());
      EXPECT_NEAR(*part.distance(t, x), least, 3e-3) << name;
      EXPECT_LE(*part.distance(t, x), least + 1e-9) << name;
    }
    std::printf("  %s: least gap %.3f mm\n", name, plan->gap_mm);
  }
}

/// What the touches of a plan read of a gear that stands off.
std::vector<TouchResult> bevel_read_of(const bevel_gear::BevelGear& gear, const inspection::TouchPlan& plan,
                                       const TouchOptions& options, const test::Stands& stands) {
  std::vector<TouchResult> out;
  for (const auto& touch : plan.touches) {
    const auto at = test::touching_centre(gear, touch.zone, touch.side, touch.space,
                                          0.5 * options.ball_diameter_mm + options.allowance_mm, stands, touch.start(),
                                          touch.centre - 1.5 * touch.normal);
    EXPECT_TRUE(at) << touch.number;
    if (at) out.push_back({touch.number, *at, {"r.txt", touch.number + 1, 1}});
  }
  return out;
}

TEST(BevelTouches, AGearThatStandsAnywhereIsFound) {
  test::Random random(29);
  for (const auto& [name, gear, options] : bevel_trials()) {
    const TouchedBevelGear part(std::make_shared<bevel_gear::BevelPart>(gear));
    const auto plan = inspection::plan_touches(part, options);
    ASSERT_TRUE(plan);
    double worst = 0, worst_turn = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const Vec3 moved = random.vector(0.15);
      const double rim = plan->reach.radius_mm, turn = random(-0.1, 0.1) / rim;
      const test::Stands stands{Mat3(Eigen::AngleAxisd(turn, Vec3::UnitZ())), moved};
      const auto place =
          inspection::place_of_part(part, *plan, options, bevel_read_of(gear, *plan, options, stands), "r.txt");
      ASSERT_TRUE(place) << name << place.error().text();
      worst = std::max(worst, (place->moved_mm - moved).norm());
      worst_turn = std::max(worst_turn, std::abs(place->clocking_rad - turn) * rim);
      EXPECT_LT(place->residual_mm, 1e-7);
      EXPECT_LT(place->tilt_rad.norm(), 1e-8);
    }
    std::printf("  %s: found within %.2e mm, turn within %.2e mm at the rim\n", name, worst, worst_turn);
    EXPECT_LT(worst, 1e-6) << name;
    EXPECT_LT(worst_turn, 1e-6) << name;
    // A leaning axis is told, and so is a touch that met a chip.
    const test::Stands leaning{Mat3(Eigen::AngleAxisd(0.05 / plan->reach.radius_mm, Vec3::UnitX())), Vec3::Zero()};
    const auto lean =
        inspection::place_of_part(part, *plan, options, bevel_read_of(gear, *plan, options, leaning), "r.txt");
    ASSERT_FALSE(lean);
    EXPECT_NE(lean.error().message.find("the axis of the gear leans: 0.0500 mm"), std::string::npos)
        << lean.error().message;
  }
}

TEST(BevelTouches, ABlankIsFoundByItsFaceCone) {
  for (const auto& [name, gear, options] : bevel_trials()) {
    const TouchedBevelGear part(std::make_shared<bevel_gear::BevelPart>(gear));
    const auto plan = inspection::plan_blank_touches(part, options);
    ASSERT_TRUE(plan) << name;
    ASSERT_EQ(plan->touches.size(), std::size_t(options.spaces) * 2);
    const double ball = 0.5 * options.ball_diameter_mm + options.allowance_mm;
    test::Random random(31);
    for (int trial = 0; trial < 10; ++trial) {
      // The ball on its line against a cone that stands off: its height above the cone is that of its centre, by
      // bisection.
      const Vec3 moved = random.vector(0.5);
      std::vector<TouchResult> results;
      for (const Touch& t : plan->touches) {
        double low = -3, high = 3;
        for (int k = 0; k < 80; ++k) {
          const double way = 0.5 * (low + high);
          const Vec3 q = t.centre + way * t.normal - moved;
          const double height = std::hypot(q.x(), q.y()) * gear.cos_delta() - q.z() * gear.sin_delta();
          (height - gear.parameters().addendum_mm < ball ? low : high) = way;
        }
        results.push_back({t.number, t.centre + 0.5 * (low + high) * t.normal, {"r.txt", t.number, 1}});
      }
      const auto place = inspection::place_of_part(part, *plan, options, results, "r.txt");
      ASSERT_TRUE(place) << name << place.error().text();
      EXPECT_LT((place->moved_mm - moved).norm(), 1e-8) << name;
      EXPECT_EQ(place->clocking_rad, 0);
    }
  }
}

TEST(BevelTouches, WhatIsTooLargeIsRefused) {
  const auto gear = bevel_test::made(bevel_test::w4(), bevel_test::wheel_mill());
  const auto large =
      inspection::plan_touches(TouchedBevelGear(std::make_shared<bevel_gear::BevelPart>(gear)), {8.0, 0, 1, 0.05, 4});
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().message.find("the largest that does is"), std::string::npos) << large.error().message;
}

}  // namespace
}  // namespace toothpath
