// Points measured on gears that are no face gears: they find their flank, tooth and deviation, and what was planted as
// pitch and run-out.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "geometry/inspection/flank_points.h"
#include "geometry/inspection/grid.h"
#include "geometry/inspection/tooth_index.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"

namespace toothpath::test {
namespace {

/// Points of all flanks of all teeth, each off by `off(tooth)` along its normal.
inspection::PointFile measured(const tooth_space::ToothedSolid& gear, const std::function<double(int)>& off,
                               bool normals, double ball = 0) {
  inspection::PointFile file;
  const auto grid = inspection::inspection_grid(gear).value();
  for (const auto& ring : gear.rings)
    for (const auto& p : grid) {
      if (p.zone != ring.zone) continue;
      const auto at = ring.space->point(tooth_space::flank_of(p.side), p.theta, p.B).value();
      for (int space = 0; space < gear.teeth; ++space) {
        const int tooth = (space + (p.side > 0 ? 0 : 1)) % gear.teeth;
        inspection::FilePoint point;
        point.p = turned(Vec3(at.p + (off(tooth) + ball) * at.n), space * gear.pitch());
        if (normals) point.n = turned(at.n, space * gear.pitch());
        file.points.push_back(point);
      }
    }
  return file;
}

void expect_points_found(const tooth_space::ToothedSolid& gear) {
  const auto off = [](int tooth) { return 0.004 * std::sin(1.7 * tooth) - 0.002 * (tooth % 3); };
  for (const bool normals : {true, false})
    for (const double ball : {0.0, 0.5}) {
      const auto placed = place_on_flanks(gear, measured(gear, off, normals, ball), ball);
      ASSERT_TRUE(placed) << placed.error().message;
      std::vector<inspection::ToothPlace> places;
      for (const auto& p : *placed) {
        ASSERT_NEAR(p.deviation_mm, off(p.tooth), 2e-9) << p.zone << " " << p.side << " " << p.tooth;
        places.push_back({p.zone, p.side, p.tooth, p.deviation_mm});
      }
      const auto index = index_of_teeth(gear, places);
      ASSERT_TRUE(index);
      ASSERT_EQ(index->pitch.size(), 2 * gear.rings.size());
      for (const auto& pitch : index->pitch) {
        EXPECT_TRUE(pitch.complete);
        // A flank that stands off along its normal stands farther along the arc.
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < gear.teeth; ++k) low = std::min(low, off(k)), high = std::max(high, off(k));
        EXPECT_GT(pitch.total_mm, high - low);
        EXPECT_LT(pitch.total_mm, 2.5 * (high - low));
      }
      EXPECT_EQ(index->run_out.size(), gear.rings.size());
    }
}

TEST(PointsOfAnyGear, FindTheirTeethOnACylinder) {
  const auto gear = made(double_helical_pinion());
  expect_points_found(drawn_solid(gear));
}
TEST(PointsOfAnyGear, FindTheirTeethOnASpiralBevelGear) {
  const auto gear = spiral_bevel::SpiralBevelGear::make(nasa_pinion()).value();
  expect_points_found(drawn_solid(gear));
}

/// A gear that turns a little beside its centre: pitch and run-out have closed forms.
TEST(PointsOfAnyGear, ASpurGearBesideItsAxisHasTheRunOutOfItsEccentricity) {
  auto parameters = shifted_spur();
  const auto gear = made(parameters);
  const auto solid = drawn_solid(gear);
  constexpr double kOff = 0.01;
  auto file = measured(
      solid, [](int) { return 0.0; }, true);
  for (auto& p : file.points) p.p.x() += kOff;
  const auto placed = place_on_flanks(solid, file).value();
  std::vector<inspection::ToothPlace> places;
  for (const int side : {1, -1})
    for (int tooth = 0; tooth < solid.teeth; ++tooth) {
      double sum = 0, count = 0;
      for (const auto& p : placed)
        if (p.side == side && p.tooth == tooth) sum += p.deviation_mm, ++count;
      ASSERT_GT(count, 0);
      places.push_back({0, side, tooth, sum / count});
    }
  const auto index = index_of_teeth(solid, places).value();
  ASSERT_EQ(index.run_out.size(), 1U);
  EXPECT_NEAR(index.run_out.front().run_out_mm, 2 * kOff, 0.1 * kOff);
}

/// A point beside all flanks is refused with how far it lies off.
TEST(PointsOfAnyGear, APointBesideAllFlanksIsRefused) {
  const auto gear = made(shifted_spur());
  const auto solid = drawn_solid(gear);
  auto file = measured(
      solid, [](int) { return 0.7; }, true);
  const auto placed = place_on_flanks(solid, file);
  ASSERT_FALSE(placed);
  EXPECT_NE(placed.error().message.find("off the nearest flank"), std::string::npos) << placed.error().message;
}

}  // namespace
}  // namespace toothpath::test
