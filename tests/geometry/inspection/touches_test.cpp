// Touches of teeth: they meet nothing but their flank, and a gear that stands anywhere is found where it stands.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/tooth_touches.h"
#include "tests/support/inspection_points.h"
#include "tests/support/random.h"
#include "tests/support/sample_gears.h"
#include "tests/support/touching_ball.h"

namespace toothpath {
namespace {

using inspection::TouchOptions;
using inspection::TouchPlan;
using inspection::TouchResult;

/// Flank +1 is that of the tooth before the space.
int tooth_of(const inspection::Touch& touch) { return touch.side > 0 ? touch.space : touch.space + 1; }

struct Trial {
  const char* name;
  face_gear::FaceGearParameters parameters;
  TouchOptions options;
};

inspection::TouchedTeeth touched(const face_gear::FaceGear& gear) {
  return inspection::TouchedTeeth(drawn_solid(gear), gear.parameters().allowance_top_mm);
}

std::vector<Trial> trials() {
  return {{"spur", test::small_spur(), {1.0, 0, 1, 0.05, 4}},
          {"offset", test::offset_gear(), {2.0, 0.1, 1, 0.05, 5}},
          {"double helical", test::quarter_dhfg(), {0.6, 0, 1, 0.03, 4}},
          {"conical", test::conical_gear(), {1.0, 0.05, 1, 0.05, 3}}};
}

/// What the touches of a plan read of a gear that stands off; noise and one that is off by more where asked.
std::vector<TouchResult> read_of(const face_gear::FaceGear& gear, const TouchPlan& plan, const TouchOptions& options,
                                 const test::Stands& stands, double noise = 0) {
  test::Random random(41);
  std::vector<TouchResult> out;
  for (const auto& touch : plan.touches) {
    const auto& f = gear.rings()[std::size_t(touch.zone)].surface;
    const Vec3 nominal = turned(touch.centre, -tooth_of(touch) * gear.pitch());
    const auto foot = face_gear::flank_distance(f, touch.side, nominal);
    const auto at =
        test::touching_centre(f, touch.side, tooth_of(touch), 0.5 * options.ball_diameter_mm + options.allowance_mm,
                              stands, touch.start(), touch.centre - 1.5 * touch.normal, foot->foot.theta, foot->foot.B);
    EXPECT_TRUE(at) << touch.number;
    if (at) out.push_back({touch.number, *at + random(-1, 1) * noise * touch.normal, {"r.txt", touch.number + 1, 1}});
  }
  return out;
}

TEST(Touches, TheBallAndItsStemMeetNothingButTheirFlank) {
  for (const auto& [name, parameters, options] : trials()) {
    const auto gear = test::made(parameters);
    const auto plan = inspection::plan_touches(touched(gear), options);
    ASSERT_TRUE(plan) << name << plan.error().message;
    EXPECT_EQ(plan->touches.size(), std::size_t(options.spaces) * 4) << name;
    EXPECT_GE(plan->gap_mm, options.least_gap_mm);
    const double ball = 0.5 * options.ball_diameter_mm;
    // The teeth as clouds of points of their flanks, finer than the gaps that are asked.
    const auto cloud = test::grid_of(gear, 60, 60);
    double least = INFINITY, touched = 0;
    for (const auto& touch : plan->touches) {
      std::vector<Vec3> near, own;
      for (int k = -2; k <= 2; ++k)
        for (const auto& p : cloud) {
          const Vec3 q = turned(p.p + options.allowance_mm * p.n, (tooth_of(touch) + k) * gear.pitch());
          if ((q - touch.centre).norm() > 3 * parameters.module_mm) continue;
          (k == 0 && p.side == touch.side && p.zone == touch.zone ? own : near).push_back(q);
        }
      const auto gap = [&](const std::vector<Vec3>& points, const Vec3& centre) {
        double out = INFINITY;
        for (const Vec3& q : points) {
          out = std::min(out, (q - centre).norm() - ball);
          if (q.z() > centre.z()) out = std::min(out, std::hypot(q.x() - centre.x(), q.y() - centre.y()) - 0.8 * ball);
        }
        return out;
      };
      for (int k = 0; k <= 10; ++k) {
        const Vec3 centre = touch.centre + 0.1 * k * touch.approach_mm * touch.normal;
        least = std::min(least, gap(near, centre));
        EXPECT_GT(gap(own, centre), -1e-3) << name;
        const Vec3 down = touch.start() + Vec3(0, 0, 0.1 * k * (plan->reach.high_mm + 5 - touch.start().z()));
        least = std::min(least, std::min(gap(near, down), gap(own, down)));
      }
      touched = std::max(touched, gap(own, touch.centre));
    }
    std::printf("  %s: least gap %.3f mm, touched within %.4f mm\n", name, least, touched);
    EXPECT_GE(least, options.least_gap_mm - 1e-6) << name;
    EXPECT_LT(touched, 0.02) << name;  // the cloud has holes
  }
}

TEST(Touches, AGearThatStandsAnywhereIsFound) {
  test::Random random(17);
  for (const auto& [name, parameters, options] : trials()) {
    const auto gear = test::made(parameters);
    const auto plan = inspection::plan_touches(touched(gear), options);
    ASSERT_TRUE(plan);
    double worst = 0, worst_turn = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 moved = random.vector(0.15);
      const double turn = random(-0.1, 0.1) / gear.outer_radius();
      const test::Stands stands{Mat3(Eigen::AngleAxisd(turn, Vec3::UnitZ())), moved};
      const auto place =
          inspection::place_of_part(touched(gear), *plan, options, read_of(gear, *plan, options, stands), "r.txt");
      ASSERT_TRUE(place) << name << place.error().text();
      worst = std::max(worst, (place->moved_mm - moved).norm());
      worst_turn = std::max(worst_turn, std::abs(place->clocking_rad - turn) * gear.outer_radius());
      EXPECT_LT(place->residual_mm, 1e-7);
      EXPECT_LT(place->tilt_rad.norm(), 1e-8);
    }
    std::printf("  %s: found within %.2e mm, turn within %.2e mm at the rim\n", name, worst, worst_turn);
    EXPECT_LT(worst, 1e-6) << name;
    EXPECT_LT(worst_turn, 1e-6) << name;
  }
}

TEST(Touches, ABlankIsFoundByItsTopAndRim) {
  const auto gear = test::made(test::small_spur());
  const TouchOptions options{3.0, 0, 1, 0.05, 4};
  const auto plan = inspection::plan_blank_touches(touched(gear), options);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->touches.size(), 8u);
  test::Random random(23);
  for (int trial = 0; trial < 20; ++trial) {
    // The ball on its line against a plane and a cylinder that stand off, written out.
    const Vec3 moved = random.vector(0.8);
    std::vector<TouchResult> results;
    for (const auto& t : plan->touches) {
      Vec3 centre = t.centre;
      if (t.normal.z() > 0.5) {
        centre.z() = gear.blank_top() + moved.z() + 1.5;
      } else {
        const Vec3 n = t.normal, from = t.centre - moved;
        const double across = from.x() * n.y() - from.y() * n.x(), far = gear.outer_radius() + 1.5;
        centre += (std::sqrt(far * far - across * across) - (from.x() * n.x() + from.y() * n.y())) * n;
      }
      EXPECT_LT((centre - t.centre).norm(), 0.9);
      results.push_back({t.number, centre, {"r.txt", t.number, 1}});
    }
    const auto place = inspection::place_of_part(touched(gear), *plan, options, results, "r.txt");
    ASSERT_TRUE(place) << place.error().text();
    EXPECT_LT((place->moved_mm - moved).norm(), 1e-9);
    EXPECT_EQ(place->clocking_rad, 0);
    auto bad = results;
    bad[3].centre += 0.3 * plan->touches[3].normal;
    const auto refused = inspection::place_of_part(touched(gear), *plan, options, bad, "r.txt");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("not agree"), std::string::npos);
  }
  // The rim is left outwards and the top upwards: nothing of the blank is on the way.
  for (const auto& t : plan->touches) {
    const Vec3 start = t.start();
    EXPECT_TRUE(radius(start) > gear.outer_radius() + 1.5 || start.z() > gear.blank_top() + 1.5);
  }
  const auto conical = test::made(test::conical_gear());
  const auto cone = inspection::plan_blank_touches(touched(conical), options);
  ASSERT_FALSE(cone);
  EXPECT_NE(cone.error().message.find("deg: it has no flat top to touch"), std::string::npos) << cone.error().message;
}

TEST(Touches, ScatterIsToldAndTheStatedDeviationsHold) {
  const auto gear = test::made(test::small_spur());
  TouchOptions options{1.0, 0, 1, 0.05, 12};
  const auto plan = inspection::plan_touches(touched(gear), options);
  ASSERT_TRUE(plan);
  const Vec3 moved(0.05, -0.08, 0.03);
  const test::Stands stands{Mat3(Eigen::AngleAxisd(1e-3, Vec3::UnitZ())), moved};
  const auto place =
      inspection::place_of_part(touched(gear), *plan, options, read_of(gear, *plan, options, stands, 0.003), "r.txt");
  ASSERT_TRUE(place) << place.error().text();
  EXPECT_GT(place->residual_mm, 0.001);
  EXPECT_LT(place->residual_mm, 0.006);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(place->moved_mm[k] - moved[k]), 4 * place->moved_sigma_mm[k]);
    EXPECT_LT(place->moved_sigma_mm[k], 0.003);
  }
  EXPECT_LT(std::abs(place->clocking_rad - 1e-3), 4 * place->clocking_sigma_rad);
}

TEST(Touches, WhatIsWrongIsNamed) {
  const auto gear = test::made(test::small_spur());
  const TouchOptions options{1.0, 0, 1, 0.05, 4};
  const auto plan = inspection::plan_touches(touched(gear), options);
  ASSERT_TRUE(plan);
  const test::Stands stands{Mat3::Identity(), {0.1, 0, 0}};
  const auto good = read_of(gear, *plan, options, stands);
  const auto error_of = [&](const std::vector<TouchResult>& results) {
    const auto place = inspection::place_of_part(touched(gear), *plan, options, results, "r.txt");
    return place ? std::string("taken") : place.error().text();
  };
  EXPECT_EQ(error_of(good), "taken");
  for (std::size_t k = 0; k < good.size(); ++k) {  // each one touch that met a chip
    auto bad = good;
    bad[k].centre += 0.2 * plan->touches[k].normal;
    EXPECT_EQ(error_of(bad).substr(0, fmt::format("r.txt:{}:1: error: touch {} does not agree", k + 2, k + 1).size()),
              fmt::format("r.txt:{}:1: error: touch {} does not agree", k + 2, k + 1));
  }
  auto copy = good;
  copy.pop_back();
  EXPECT_EQ(error_of(copy), "r.txt:1:1: error: touch 16 of 16 is missing");
  copy = good;
  copy[3].number = 2;
  EXPECT_EQ(error_of(copy), "r.txt:5:1: error: touch 2 stands in line 3 already");
  copy = good;
  copy[0].number = 17;
  EXPECT_EQ(error_of(copy).substr(0, 60), "r.txt:2:1: error: touch 17 is none of the plan, which has 1 ");
  copy = good;
  for (auto& r : copy) r.centre /= 25.4;
  EXPECT_NE(error_of(copy).find("another part, frame or unit"), std::string::npos);
  // An axis that leans by 0.05 mm at the rim.
  const test::Stands leaning{Mat3(Eigen::AngleAxisd(0.05 / gear.outer_radius(), Vec3::UnitX())), Vec3::Zero()};
  EXPECT_NE(error_of(read_of(gear, *plan, options, leaning)).find("the axis of the gear leans: 0.0500 mm at radius"),
            std::string::npos)
      << error_of(read_of(gear, *plan, options, leaning));
  const auto large = inspection::plan_touches(touched(gear), {4.0, 0, 1, 0.05, 4});
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().message.find("the largest that does is"), std::string::npos) << large.error().message;
  EXPECT_FALSE(inspection::plan_touches(touched(gear), {1.0, 0, 1, 0.05, 2}));
}

}  // namespace
}  // namespace toothpath
