// On which side of the feed the material lies: to the right, seen from the holder, when climbing; to the left
// otherwise. No pass turns back.
#include "cam/ball/finishing.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

struct Sides {
  double right_mm = 0,
         left_mm = 0;  ///< way of contacts beside the feed; those within 6 deg of below the ball count as neither
  int turns = 0;       ///< points where the feed turns by more than 60 deg
};

/// A tool along the gear axis.
Sides sides_of(const face_gear::FaceGearParameters& gear, double ball, double scallop, double allowance, bool climb) {
  const face_gear::FaceGear made = test::made(gear);
  const analytic::GearDistance part(face_gear::part_of(made), 1.3 * ball + allowance + 0.6);
  Sides out;
  for (std::size_t z = 0; z < gear.zones.size(); ++z) {
    const auto& zone = gear.zones[z];
    const double margin = ball + allowance + 0.1;
    const tooth_space::OffsetSheet sheet(part.space(int(z)), ball + allowance, zone.inner_radius_mm - margin,
                                         zone.outer_radius_mm + margin, 33);
    ball::FinishingOptions o;
    o.ball_radius_mm = ball;
    o.allowance_mm = allowance;
    o.scallop_mm = path::ByRegion<double>::everywhere(scallop);
    o.chord_mm = 0.002;
    o.run_out_mm = 0.5 * ball;
    o.climb = climb;
    const auto plan = ball::plan_finishing(sheet, o);
    EXPECT_TRUE(plan) << plan.error().message;
    if (!plan) return out;
    for (const auto& pass : plan->passes)
      for (std::size_t k = 1; k < pass.points.size(); ++k) {
        const auto& p = pass.points[k];
        const Vec3 way = p.centre - pass.points[k - 1].centre;
        if (!p.touching || !pass.points[k - 1].touching) continue;
        const Vec3 right = way.normalized().cross(Vec3::UnitZ());
        if (k > 1 && way.normalized().dot((pass.points[k - 1].centre - pass.points[k - 2].centre).normalized()) < 0.5)
          ++out.turns;
        const double share = (p.contact - p.centre).normalized().dot(right);
        if (share > 0.1) out.right_mm += way.norm();
        if (share < -0.1) out.left_mm += way.norm();
      }
  }
  return out;
}

TEST(ClimbSide, EveryPassOnFlankAndFilletHasTheMaterialOnTheAskedSide) {
  auto mirrored = test::offset_gear();
  mirrored.offset_mm = -mirrored.offset_mm;
  auto helical = test::offset_gear();
  helical.offset_mm = 6;
  helical.zones = {{radians(-15), 136, 144}};
  struct Case {
    const char* name;
    face_gear::FaceGearParameters gear;
    double ball, scallop, allowance;
    bool climb;
  };
  const Case cases[] = {{"offset", test::offset_gear(), 0.8, 0.006, 0, true},
                        {"mirrored", mirrored, 0.8, 0.006, 0, false},
                        {"helical", helical, 0.7, 0.01, 0, true},
                        {"semi-finishing", test::offset_gear(), 0.7, 0.02, 0.05, true},
                        {"dhfg", test::quarter_dhfg(), 0.25, 0.004, 0, true},
                        {"a corner that opens inside the ring", test::quarter_dhfg(), 0.3, 0.004, 0, true},
                        {"spur", test::small_spur(), 0.5, 0.01, 0, false}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    const Sides s = sides_of(c.gear, c.ball, c.scallop, c.allowance, c.climb);
    EXPECT_GT(c.climb ? s.right_mm : s.left_mm, 50.0);
    EXPECT_EQ(c.climb ? s.left_mm : s.right_mm, 0.0);
    EXPECT_EQ(s.turns, 0);
  }
}

}  // namespace
}  // namespace toothpath
