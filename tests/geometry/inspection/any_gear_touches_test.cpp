// Touches of gears that stand on the tooth space alone: cylindrical gears, straight and spiral bevel gears, points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/cylindrical/part.h"
#include "geometry/inspection/tooth_touches.h"
#include "geometry/tooth_space/limits.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

TEST(AnyGearTouches, BallAndStemMeetNothingButTheirFlank) {
  for (const auto& parameters : cylindrical_samples()) {
    const auto gear = made(parameters);
    const inspection::TouchedTeeth part(drawn_solid(gear));
    const inspection::TouchOptions options{0.5 * parameters.module_mm, 0.05, 1, 0.05, 4};
    const auto plan = inspection::plan_touches(part, options);
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->touches.size(), std::size_t(options.spaces) * 5);
    const double ball = 0.5 * options.ball_diameter_mm;
    // Flanks and fillets of the space as a cloud.
    for (const auto& touch : plan->touches) {
      const auto& space = gear.space(touch.zone);
      if (touch.what == inspection::Touched::end) {
        EXPECT_EQ(touch.surface.z(), parameters.zones.front().from_mm);
        EXPECT_EQ(touch.centre.z(), parameters.zones.front().from_mm - ball);
        // In the middle of the tooth before the space.
        EXPECT_NEAR(std::remainder(azimuth(touch.surface) - space.kernel().kappa * touch.surface.z() -
                                       (touch.space - 0.5) * space.outline().pitch,
                                   kTwoPi),
                    0, 1e-9);
        continue;
      }
      std::vector<Vec3> cloud;
      for (const auto piece :
           {tooth_space::Piece::flank_plus, tooth_space::Piece::fillet_plus, tooth_space::Piece::root,
            tooth_space::Piece::fillet_minus, tooth_space::Piece::flank_minus}) {
        const auto borders = space.borders(piece);
        const double tip = space.kernel().theta_a;
        for (int i = 0; i <= 60; ++i)
          for (int j = 0; j <= 60; ++j) {
            const double from = std::isinf(borders.from) ? tip : borders.from,
                         to = std::isinf(borders.to) ? tip : borders.to;
            const auto& zone = parameters.zones[std::size_t(touch.zone)];
            const auto q =
                space.point(piece, from + (to - from) * i / 60, zone.from_mm + (zone.to_mm - zone.from_mm) * j / 60);
            cloud.push_back(turned(Vec3(q->p + options.allowance_mm * q->n), touch.space * space.outline().pitch));
          }
      }
      const auto gap = [&](const Vec3& centre) {
        double out = INFINITY;
        for (const Vec3& q : cloud) {
          out = std::min(out, (q - centre).norm() - ball);
          const double up = touch.up.dot(q - centre);
          if (up > 0) out = std::min(out, (q - centre - up * touch.up).norm() - 0.8 * ball);
        }
        return out;
      };
      EXPECT_GT(gap(touch.centre), -1e-9);
      EXPECT_LT(gap(touch.centre), 0.03);  // the cloud has holes
      EXPECT_NEAR(touch.up.z(), 0, 1e-12);
      for (int k = 0; k <= 5; ++k)
        EXPECT_GE(gap(touch.start() + 0.2 * k * parameters.module_mm * 3 * touch.up), options.least_gap_mm - 1e-6);
    }
  }
}

/// Along the line of each touch to where the ball meets what stands off: there its gap is 0.
template <typename Gap>
std::vector<inspection::TouchResult> met(const inspection::TouchPlan& plan, const Gap& gap) {
  std::vector<inspection::TouchResult> out;
  for (const auto& touch : plan.touches) {
    double near = -0.5, far = 0.5;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (near + far);
      (gap(touch, Vec3(touch.centre + middle * touch.normal)) < 0 ? near : far) = middle;
    }
    out.push_back({touch.number, touch.centre + far * touch.normal, {"r.txt", touch.number, 1}});
  }
  return out;
}

TEST(AnyGearTouches, AGearThatStandsAnywhereIsFound) {
  Random random(17);
  for (const auto& parameters : cylindrical_samples()) {
    const auto gear = made(parameters);
    const inspection::TouchedTeeth part(drawn_solid(gear));
    const inspection::TouchOptions options{0.5 * parameters.module_mm, 0, 1, 0.05, 4};
    const double ball = 0.5 * options.ball_diameter_mm;
    const auto plan = inspection::plan_touches(part, options), blank = inspection::plan_blank_touches(part, options);
    ASSERT_TRUE(plan);
    ASSERT_TRUE(blank);
    for (int trial = 0; trial < 5; ++trial) {
      const Vec3 moved = random.vector(0.1);
      const double turn = random(-0.1, 0.1) / (0.5 * gear.tip_diameter());
      const auto read = [&](const inspection::TouchPlan& of, double turn_of, const auto& distance) {
        return met(of, [&](const inspection::Touch& touch, const Vec3& at) {
          return distance(touch, turned(Vec3(at - moved), -turn_of)) - ball;
        });
      };
      const auto on_flank = [&](const inspection::Touch& touch, const Vec3& x) {
        if (touch.what == inspection::Touched::end) return parameters.zones.front().from_mm - x.z();
        const auto& space = gear.space(touch.zone);
        const Vec3 home = turned(x, -touch.space * space.outline().pitch);
        const double u = space.kernel().theta_at(radius(touch.surface));
        return space.foot(tooth_space::flank_of(touch.side), home, u, home.z()).value().distance;
      };
      const auto place = inspection::place_of_part(part, *plan, options, read(*plan, turn, on_flank), "r.txt");
      ASSERT_TRUE(place) << place.error().text();
      EXPECT_LT((place->moved_mm - moved).norm(), 1e-6);
      EXPECT_NEAR(place->clocking_rad, turn, 1e-8);
      const auto on_blank = [&](const inspection::Touch& touch, const Vec3& x) {
        return touch.what == inspection::Touched::top ? radius(x) - 0.5 * gear.tip_diameter()
                                                      : parameters.zones.front().from_mm - x.z();
      };
      const auto of_blank = inspection::place_of_part(part, *blank, options, read(*blank, 0, on_blank), "r.txt");
      ASSERT_TRUE(of_blank) << of_blank.error().text();
      EXPECT_LT((of_blank->moved_mm - moved).norm(), 1e-6);
      EXPECT_EQ(of_blank->clocking_rad, 0);
    }
  }
}

/// A cone shows its place along the axis by its flanks; its blank has no flat top.
void expect_found(const tooth_space::ToothedSolid& solid) {
  Random random(4);
  const tooth_space::ToothSpace& space = *solid.rings.front().space;
  const auto& ring = space.outline();
  const inspection::TouchedTeeth part(solid);
  const inspection::TouchOptions options{1.2, 0, 1, 0.05, 4};
  const auto plan = inspection::plan_touches(part, options);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->touches.size(), std::size_t(options.spaces) * 4);
  EXPECT_FALSE(inspection::plan_blank_touches(part, options));
  for (int trial = 0; trial < 3; ++trial) {
    const Vec3 moved = random.vector(0.1);
    const double turn = random(-0.003, 0.003);
    const auto results = met(*plan, [&](const inspection::Touch& touch, const Vec3& at) {
      const Vec3 home = turned(Vec3(at - moved), -turn - touch.space * ring.pitch);
      const auto piece = tooth_space::flank_of(touch.side);
      const double s = std::clamp(ring.chart.along(home), ring.s_from, ring.s_to);
      const auto borders = space.borders(piece);
      const double u =
          0.5 * (space.tip_edge(touch.side, s)->u + (std::isfinite(borders.from) ? borders.from : borders.to));
      return space.foot(piece, home, u, *tooth_space::v_at(space, piece, u, s)).value().distance -
             0.5 * options.ball_diameter_mm;
    });
    const auto place = inspection::place_of_part(part, *plan, options, results, "r.txt");
    ASSERT_TRUE(place) << place.error().text();
    EXPECT_LT((place->moved_mm - moved).norm(), 1e-6);
    EXPECT_NEAR(place->clocking_rad, turn, 1e-8);
  }
}
TEST(AnyGearTouches, GearsOnAConeAreFoundByTheirFlanks) {
  const auto straight = straight_bevel::StraightBevelGear::make(khk_pinion()).value();
  const auto pinion = spiral_bevel::SpiralBevelGear::make(nasa_pinion()).value(),
             wheel = spiral_bevel::SpiralBevelGear::make(formate_wheel()).value();
  const auto points = flank_grid::FlankGridGear::make(sampled(khk_pinion(), {9, 9, 0.75})).value();
  for (const auto& [name, solid] : {std::pair("straight", drawn_solid(straight)),
                                    {"spiral pinion", drawn_solid(pinion)},
                                    {"Formate wheel", drawn_solid(wheel)},
                                    {"points", drawn_solid(points)}}) {
    SCOPED_TRACE(name);
    expect_found(solid);
  }
}

}  // namespace
}  // namespace toothpath::test
