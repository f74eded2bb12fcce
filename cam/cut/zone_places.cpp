#include "cam/cut/zone_places.h"

#include <algorithm>

namespace toothpath::cut {

ZonePlaces::ZonePlaces(const analytic::GearDistance& part, int zone)
    : space_(part.space(zone)),
      sheet_(space_, 0.0, space_.ring().zone.inner_radius_mm, space_.ring().zone.outer_radius_mm, 49) {}

double ZonePlaces::radius(double share) const {
  const auto& z = space_.ring().zone;
  return std::clamp(z.inner_radius_mm + share * (z.outer_radius_mm - z.inner_radius_mm), sheet_.r_from(),
                    sheet_.r_to());
}

/// sigma where the flank leaves through the tip surface.
double ZonePlaces::tip_sigma(bool plus, double r) const {
  const double z_tip = space_.surface().z_tip(r);
  double out = plus ? 0.0 : 5.0, in = plus ? 1.0 : 4.0;
  const auto above = [&](double sigma) {
    const auto s = at(sigma, r);
    return !s || s->contact.p.z() > z_tip;
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
