// The largest first tool: it fits where it is said to, and nothing larger does.
#include "cam/plan/first_ball.h"

#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/face_part.h"

namespace toothpath {
namespace {

TEST(FirstBall, FitsInTheUpperHalfAndNoLargerOneDoes) {
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const double m = gear.parameters().module_mm, allowance = 0.1 * m, reach = 4 * m;
    const analytic::GearDistance part(face_gear::part_of(gear), reach);
    const double D = plan::first_ball_mm(part, allowance, reach);
    std::printf("%s: %.3f modules\n", name.c_str(), D / m);
    ASSERT_GT(D, 0.5 * m) << name;
    ASSERT_LT(D, 4 * m) << name;
    // Half height: the middle of where, on the way down the middle of the space, the part begins.
    bool larger_fits = true;
    for (int zone = 0; zone < part.zones(); ++zone)
      for (const double share : {0.0, 0.5, 1.0}) {
        const auto& ring = test::sheet_of(part.space(zone)).ring().zone;
        const double r = ring.inner_radius_mm + share * (ring.outer_radius_mm - ring.inner_radius_mm),
                     azimuth = part.space_azimuth(zone, r), top = test::sheet_of(part.space(zone)).surface().z_tip(r);
        const auto distance = [&](double z) {
          return part.nearest({r * std::cos(azimuth), r * std::sin(azimuth), z}, reach).distance;
        };
        double bottom = top;
        while (distance(bottom) > 0) bottom -= 0.002 * m;
        const double half = 0.5 * (top + bottom);
        EXPECT_GE(distance(half + D / 2) - D / 2, allowance - 0.002 * m) << name;
        larger_fits = larger_fits && distance(half + D / 2 + 0.005 * m) - D / 2 - 0.005 * m >= allowance;
      }
    EXPECT_FALSE(larger_fits) << name;
    EXPECT_LE(plan::first_ball_mm(part, allowance, 0.4 * m), 0.8 * m);
  }
}

}  // namespace
}  // namespace toothpath
