// The blank of any toothed gear is its turned body.
#include <gtest/gtest.h>

#include "cam/rest/toothed_blank.h"
#include "geometry/cylindrical/part.h"
#include "geometry/mesh/cgal_check.h"
#include "tests/geometry/cylindrical/samples.h"

namespace toothpath::rest {
namespace {

TEST(ToothedBlank, OfACylindricalGearIsItsCylindersWithAndWithoutBore) {
  auto without_bore = test::double_helical_pinion();
  without_bore.bore_diameter_mm = 0;
  for (const auto& parameters :
       {test::shifted_spur(), test::double_helical_pinion(), test::left_helical(), without_bore}) {
    const auto gear = test::made(parameters);
    constexpr double kAbove = 0.3;
    const Blank blank = blank_of(drawn_solid(gear), kAbove);
    const auto rest = rest_mesh(blank, {});
    ASSERT_TRUE(rest);
    const auto check = mesh::check_mesh(rest->mesh);
    ASSERT_TRUE(check) << check.error().message;
    EXPECT_TRUE(check->is_solid()) << check->self_intersections << " crossings";
    EXPECT_EQ(check->components, 1u);
    const auto disc = [](double diameter) { return 0.25 * kPi * diameter * diameter; };
    const auto& zones = parameters.zones;
    const double bore = disc(parameters.bore_diameter_mm), tip = disc(gear.tip_diameter() + 2 * kAbove);
    double volume = 0;
    for (const auto& zone : zones) volume += (zone.to_mm - zone.from_mm) * (tip - bore);
    if (zones.size() > 1) volume += (zones[1].from_mm - zones[0].to_mm) * (disc(gear.groove_diameter()) - bore);
    EXPECT_NEAR(check->volume_mm3, volume, 2e-4 * volume);
    double low = INFINITY, high = -INFINITY;
    for (const Vec3& p : rest->mesh.vertices) low = std::min(low, p.z()), high = std::max(high, p.z());
    EXPECT_EQ(low, zones.front().from_mm);
    EXPECT_EQ(high, zones.back().to_mm);
    EXPECT_EQ(blank.rings.front().begin(blank.rings.front().from), 0);
  }
}

}  // namespace
}  // namespace toothpath::rest
