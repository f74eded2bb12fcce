#include "geometry/bevel_gear/convex_corner.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::bevel_gear {

ConvexCorner::ConvexCorner(const BevelGear& gear)
    : sigma_(-gear.corner().sigma),
      R_J_(gear.R_ref()),
      theta_(-sigma_ * gear.e_h() * gear.sin_delta()),
      beta_J_(gear.halves().front().walls[0].trace.beta(R_J_)),
      sin_delta_(gear.sin_delta()),
      r_0_(gear.cutter().r_0),
      inner_(gear.halves().front().walls[0].trace.distance(sigma_, beta_J_).d),
      outer_(gear.halves().back().walls[0].trace.distance(sigma_, beta_J_).d) {}

CutterCentre<double> ConvexCorner::at(double t) const {
  // Direction from the corner of the trace to the centre, measured from the ray through it.
  const double direction = sigma_ * (kPi / 2 + beta_J_ * (1 - 2 * t)), r = radius(t);
  const double turn = std::atan2(r * std::sin(direction), R_J_ + r * std::cos(direction));
  CutterCentre<double> c;
  c.R_c = std::hypot(R_J_ + r * std::cos(direction), r * std::sin(direction));
  c.theta_c = theta_ + turn;
  c.e = c.theta_c / sin_delta_;
  c.beta_c = direction - sigma_ * kPi / 2 - turn;
  if (!plain()) c.beta_c += sigma_ * std::atan2(outer_ - inner_, 2 * beta_J_ * r);
  return c;
}

double ConvexCorner::share_at(double R_c) const {
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (low + high);
    (at(mid).R_c < R_c ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

double ConvexCorner::offset(double R_c, double theta) const {
  const double turn = theta - theta_, u = R_c * std::cos(turn) - R_J_, v = R_c * std::sin(turn);
  const double distance = std::hypot(u, v);
  double r = r_0_;
  if (!plain()) r = radius(std::clamp(0.5 * (1 - (sigma_ * std::atan2(v, u) - kPi / 2) / beta_J_), 0.0, 1.0));
  return (turn * sigma_ > 0 ? distance : -distance) - r;
}

}  // namespace toothpath::bevel_gear
