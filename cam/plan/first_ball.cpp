#include "cam/plan/first_ball.h"

#include <algorithm>
#include <cmath>

namespace toothpath::plan {
namespace {

constexpr double kFound = 5e-4;  // mm of radius, and of the bottom's height

/// Height of the bottom of a space in its middle: below it the part is solid.
double bottom_of(const analytic::GearDistance& part, int zone, double r, double azimuth) {
  double high = part.space(zone).surface().z_tip(r), low = part.gear().lowest_root() - kFound;
  while (high - low > kFound) {
    const double z = 0.5 * (low + high);
    (part.nearest({r * std::cos(azimuth), r * std::sin(azimuth), z}, kFound).distance > 0 ? high : low) = z;
  }
  return high;
}

double largest_radius_at(const analytic::GearDistance& part, int zone, double r, double allowance, double reach) {
  const double azimuth = part.space_azimuth(zone, r),
               half = 0.5 * (part.space(zone).surface().z_tip(r) + bottom_of(part, zone, r, azimuth));
  double low = 0, high = reach - allowance;
  while (high - low > kFound) {
    const double R = 0.5 * (low + high);
    const Vec3 centre(r * std::cos(azimuth), r * std::sin(azimuth), half + R);
    (part.nearest(centre, R + allowance).distance >= R + allowance ? low : high) = R;
  }
  return low;
}

}  // namespace

double first_ball_mm(const analytic::GearDistance& part, double allowance_mm, double reach_mm) {
  double least = INFINITY;
  for (int zone = 0; zone < part.zones(); ++zone) {
    const auto& ring = part.space(zone).ring().zone;
    for (const double share : {0.0, 0.5, 1.0})
      least = std::min(
          least,
          largest_radius_at(part, zone, ring.inner_radius_mm + share * (ring.outer_radius_mm - ring.inner_radius_mm),
                            allowance_mm, reach_mm));
  }
  return 2 * least;
}

}  // namespace toothpath::plan
