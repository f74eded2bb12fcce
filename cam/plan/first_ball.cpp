#include "cam/plan/first_ball.h"

#include <algorithm>
#include <cmath>

namespace toothpath::plan {
namespace {

constexpr double kFound = 5e-4;  // mm of radius, and of the bottom's height

/// Height of the bottom of a space in its middle: below it the part is solid.
double bottom_of(const analytic::GearDistance& part, int zone, double s, double azimuth) {
  double high = part.space(zone).tip(s), low = part.part().lowest_root() - kFound;
  while (high - low > kFound) {
    const double h = 0.5 * (low + high);
    (part.nearest(part.part().chart().place(s, azimuth, h), kFound).distance > 0 ? high : low) = h;
  }
  return high;
}

double largest_radius_at(const analytic::GearDistance& part, int zone, double s, double allowance, double reach) {
  const double azimuth = part.space_azimuth(zone, s),
               half = 0.5 * (part.space(zone).tip(s) + bottom_of(part, zone, s, azimuth));
  double low = 0, high = reach - allowance;
  while (high - low > kFound) {
    const double R = 0.5 * (low + high);
    const Vec3 centre = part.part().chart().place(s, azimuth, half + R);
    (part.nearest(centre, R + allowance).distance >= R + allowance ? low : high) = R;
  }
  return low;
}

}  // namespace

double first_ball_mm(const analytic::GearDistance& part, double allowance_mm, double reach_mm) {
  double least = INFINITY;
  for (int zone = 0; zone < part.zones(); ++zone) {
    const auto& ring = part.space(zone).outline();
    for (const double share : {0.0, 0.5, 1.0})
      least = std::min(least, largest_radius_at(part, zone, ring.s_from + share * (ring.s_to - ring.s_from),
                                                allowance_mm, reach_mm));
  }
  return 2 * least;
}

}  // namespace toothpath::plan
