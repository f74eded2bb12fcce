#include "cam/cut/zone_places.h"

#include <algorithm>

namespace toothpath::cut {

ZonePlaces::ZonePlaces(const analytic::GearDistance& part, int zone)
    : space_(part.space(zone)), sheet_(space_, 0.0, space_.outline().s_from, space_.outline().s_to, 49) {}

double ZonePlaces::radius(double share) const {
  const auto& ring = space_.outline();
  return std::clamp(ring.s_from + share * (ring.s_to - ring.s_from), sheet_.r_from(), sheet_.r_to());
}

/// sigma where the flank leaves through the tip surface.
double ZonePlaces::tip_sigma(bool plus, double r) const {
  const double tip = space_.tip(r);
  double out = plus ? 0.0 : 5.0, in = plus ? 1.0 : 4.0;
  const auto above = [&](double sigma) {
    const auto s = at(sigma, r);
    return !s || space_.outline().chart.up(s->contact.p) > tip;
  };
  if (!above(out)) return out;
  for (int k = 0; k < 40; ++k) {
    const double m = 0.5 * (out + in);
    (above(m) ? out : in) = m;
  }
  return in;
}

std::pair<double, double> ZonePlaces::range(tooth_space::Piece piece, double r) const {
  switch (piece) {
    case tooth_space::Piece::flank_plus: return {tip_sigma(true, r), 1.0};
    case tooth_space::Piece::fillet_plus: return {1.0, 2.0};
    case tooth_space::Piece::root: return {2.0, 3.0};
    case tooth_space::Piece::fillet_minus: return {3.0, 4.0};
    case tooth_space::Piece::flank_minus: return {4.0, tip_sigma(false, r)};
    default: return {0, 0};
  }
}

}  // namespace toothpath::cut
