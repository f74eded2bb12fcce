// Inspection points of gears that stand on the tooth space alone: the cylindrical gear, judged by the involute itself.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cylindrical/part.h"
#include "geometry/inspection/grid.h"
#include "tests/geometry/cylindrical/samples.h"

namespace toothpath::test {
namespace {

TEST(AnyGearInspection, PointsLieOnTheInvoluteAndTheirNormalsPointOutOfTheMaterial) {
  for (const auto& parameters : cylindrical_samples()) {
    const auto gear = made(parameters);
    const auto grid = inspection::inspection_grid(drawn_solid(gear), {7, 11, 0.05});
    ASSERT_TRUE(grid) << grid.error().message;
    ASSERT_EQ(grid->size(), std::size_t(gear.zones()) * 2 * 7 * 11);
    std::size_t k = 0;
    for (int zone = 0; zone < gear.zones(); ++zone)
      for (const int side : {1, -1}) {
        const auto& w = gear.space(zone).kernel();
        for (int row = 0; row < 7; ++row)
          for (int column = 0; column < 11; ++column, ++k) {
            const inspection::InspectionPoint& at = (*grid)[k];
            ASSERT_EQ(std::tuple(at.zone, at.side, at.row, at.column), std::tuple(zone, side, row, column));
            // The involute unrolls from the base cylinder: half the space is eta at this radius.
            const double theta = w.theta_at(radius(at.p)), half = w.eta_b + theta - std::atan(theta);
            const double off = std::remainder(azimuth(at.p) - (w.kappa * at.p.z() - side * half), kTwoPi);
            ASSERT_NEAR(off * radius(at.p), 0, 1e-9);
            // Its normal touches the base cylinder at the base helix, and looks into the space.
            ASSERT_NEAR(at.n.norm(), 1, 1e-12);
            ASSERT_NEAR(std::abs(at.p.x() * at.n.y() - at.p.y() * at.n.x()), w.r_b * w.cos_bb, 1e-9);
            ASSERT_GT(side * (at.p.x() * at.n.y() - at.p.y() * at.n.x()), 0);
            ASSERT_GT(at.n.dot(at.p) - at.n.z() * at.p.z(), 0);
            ASSERT_GT(at.p.z(), parameters.zones[std::size_t(zone)].from_mm);
            ASSERT_LT(at.p.z(), parameters.zones[std::size_t(zone)].to_mm);
            ASSERT_GT(theta, w.theta_f);
            ASSERT_LT(theta, w.theta_a);
          }
      }
  }
}

}  // namespace
}  // namespace toothpath::test
