// The largest first tool: it fits where it is said to, and nothing larger does.
#include "cam/plan/first_ball.h"

#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

TEST(FirstBall, FitsInTheUpperHalfAndNoLargerOneDoes) {
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const double m = gear.parameters().module_mm, allowance = 0.1 * m, reach = 4 * m;
    const analytic::GearDistance part(gear, reach);
    const double D = plan::first_ball_mm(part, allowance, reach);
    std::printf("%s: %.3f modules\n", name.c_str(), D / m);
    ASSERT_GT(D, m) << name;
    ASSERT_LT(D, 4 * m) << name;
    bool larger_fits = true;
    for (int zone = 0; zone < part.zones(); ++zone)
      for (const double share : {0.0, 0.5, 1.0}) {
        const auto& ring = part.space(zone).ring().zone;
        const double r = ring.inner_radius_mm + share * (ring.outer_radius_mm - ring.inner_radius_mm),
                     azimuth = part.space_azimuth(zone, r),
                     half = 0.5 * (part.space(zone).surface().z_tip(r) + gear.lowest_root());
        const auto room = [&](double R) {
          return part.nearest({r * std::cos(azimuth), r * std::sin(azimuth), half + R}, reach).distance - R;
        };
        EXPECT_GE(room(D / 2), allowance - 1e-9) << name;
        larger_fits = larger_fits && room(D / 2 + 0.005) >= allowance;
      }
    EXPECT_FALSE(larger_fits) << name;
    EXPECT_LE(plan::first_ball_mm(part, allowance, 0.4 * m), 0.8 * m);
  }
}

}  // namespace
}  // namespace toothpath
