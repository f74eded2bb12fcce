// Extreme pairs and loads end in a result or in a refusal that names what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/face_gear/limits.h"
#include "tests/geometry/loaded/spur_pair.h"

namespace toothpath::test {
namespace {

TEST(Extremes, ATorqueThatIsNoneIsRefused) {
  loaded::LoadedPair pair = spur_pair();
  for (const bool cells : {false, true}) {
    pair.options.cells = cells;
    for (const auto& [torque, words] : {std::pair(0.0, "torque = 0 N m on the gear is not above 0"),
                                        {-5e3, "torque = -5 N m"},
                                        {std::numeric_limits<double>::quiet_NaN(), "torque = nan N m"},
                                        {std::numeric_limits<double>::infinity(), "torque = inf N m"}}) {
      loaded::Load load;
      load.torque_nmm = torque;
      const auto found = loaded::loaded_position(pair, load, 0);
      ASSERT_FALSE(found);
      EXPECT_NE(found.error().message.find(words), std::string::npos) << found.error().message;
    }
  }
}

TEST(Extremes, AMillionNewtonMetresAndAMillionthAreNumbers) {
  const loaded::LoadedPair pair = spur_pair();
  double before = 0;
  for (const double torque : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const auto p = spur_position(pair, torque, 0.2);
    EXPECT_TRUE(std::isfinite(p.approach_mm));
    EXPECT_GT(p.approach_mm, before);
    EXPECT_GT(p.pressure, 0);
    EXPECT_LT(p.residual, 1e-8);
    before = p.approach_mm;
  }
}

/// A tooth whose top land is nearly nothing at its outer end.
TEST(Extremes, ANearlyPointedToothCarries) {
  face_gear::FaceGearParameters p = spur_gear().parameters();
  const auto limits = face_gear::zone_limits(face_gear::make_surface<double>(p, 0), p.module_mm);
  ASSERT_TRUE(limits.pointing_radius);
  p.zones = {{0, kSpurInner, *limits.pointing_radius - 0.01}};
  p.least_land_mm = 0;
  auto made = face_gear::FaceGear::make(p);
  ASSERT_EQ(made.refused(), nullptr) << made.refused()->front().diagnostic.message;
  const auto pair = loaded::make_loaded_pair(made.value(), 1, 20, spur_options());
  ASSERT_TRUE(pair) << pair.error().message;
  for (const double phase : {0.0, 0.5}) {
    const auto found = spur_position(*pair, 20, phase);
    EXPECT_TRUE(std::isfinite(found.approach_mm) && found.approach_mm > 0);
    EXPECT_TRUE(std::isfinite(found.pressure) && found.pressure > 0);
  }
}

/// A pinion so far out of line that only one end of the face bears: the load stands on ends of lines.
TEST(Extremes, EdgesAloneCarry) {
  loaded::LoadedPair pair = spur_pair();
  pair.options.moved.angle_rad = 0.02;
  pair.rings[0].moved = contact::make_pinion(pair.rings[0].surface, 20, pair.options.moved);
  const auto strips = spur_position(pair, 0.01, 0.2);
  EXPECT_EQ(strips.pressure, 0) << "no inner piece";
  EXPECT_GT(strips.end_pressure, 0);
  EXPECT_GT(strips.end_line_load, 0);
  pair.options.cells = true;
  const auto cells = spur_position(pair, 0.01, 0.2);
  EXPECT_GT(cells.end_line_load, 0);
  double force = 0;
  for (const auto& s : cells.segments) force += s.force;
  EXPECT_NEAR(force, 10 / pair.lever, 1e-6 * force);
}

}  // namespace
}  // namespace toothpath::test
