#include "geometry/bevel_gear/pass.h"

#include "geometry/base/angle.h"

namespace toothpath::bevel_gear {

std::optional<double> beta_at_centre(const BevelTrace<double>& t, int sigma, double R_c) {
  double lo = 0.0, hi = kPi / 2 - 1e-6;
  // The straight end of an eps = +1 path goes on for any negative parameter; near beta_e = 0 a unit of it is short.
  for (double reach = 1; - sigma * t.h > 0 && reach < 1e4 && t.centre(sigma, lo).R_c < R_c; reach *= 2) lo = -reach;
  if (t.centre(sigma, lo).R_c < R_c || t.centre(sigma, hi).R_c > R_c) return std::nullopt;
  for (int k = 0; k < 200 && hi - lo > 1e-16; ++k) {
    const double mid = 0.5 * (lo + hi);
    if (mid <= lo || mid >= hi) break;
    (t.centre(sigma, mid).R_c > R_c ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

}  // namespace toothpath::bevel_gear
