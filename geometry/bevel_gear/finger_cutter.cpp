#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::bevel_gear {

FingerSolid::FingerSolid(const FingerProfile<double>& profile) : c_(profile) {}

double FingerSolid::radius(double x) const {
  if (x >= c_.x_D) return c_.rho_D;
  if (x < c_.x_B) {
    const double u = c_.x_o - x, w = c_.r_t * c_.r_t - u * u;
    return c_.rho_o + (w > 0 ? std::sqrt(w) : 0.0);
  }
  if (x <= c_.x_C) return c_.line_radius(x);
  // Newton on the involute, x(p) = x; monotone, starts on the rack.
  double p = std::max(x / (c_.sin_a * c_.cos_a), c_.p_C + 1e-3 * (c_.p_D - c_.p_C));
  for (int k = 0; k < 50; ++k) {
    const auto q = c_.involute(p);
    const double step = (q.x - x) / (q.dS * q.cos_psi);
    p = std::clamp(p - step, c_.p_C, c_.p_D);
    if (std::abs(step) < 1e-14 * (1 + c_.r_0)) break;
  }
  return c_.involute(p).rho;
}

double FingerSolid::lower_surface(double rho) const {
  if (rho <= c_.rho_o) return -c_.h_f;
  if (rho <= c_.rho_B) {
    const double u = rho - c_.rho_o, w = c_.r_t * c_.r_t - u * u;
    return c_.x_o - (w > 0 ? std::sqrt(w) : 0.0);
  }
  if (rho <= c_.rho_C) return c_.x_C + (rho - c_.rho_C) * c_.cos_phi / c_.sin_phi;
  if (rho >= c_.rho_D) return c_.x_D;
  // Newton on rho(p), kept inside a shrinking bracket: d rho/dp vanishes where the profile is parallel to the axis.
  double lo = c_.p_C, hi = c_.p_D, p = lo + (hi - lo) * (rho - c_.rho_C) / (c_.rho_D - c_.rho_C);
  for (int k = 0; k < 80; ++k) {
    const auto q = c_.involute(p);
    (q.rho < rho ? lo : hi) = p;
    const double slope = q.dS * q.sin_psi, newton = p - (q.rho - rho) / slope;
    const double next = slope > 0 && newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
    if (std::abs(next - p) <= 1e-14 * (1 + c_.r_0)) break;
    p = next;
  }
  return c_.involute(p).x;
}

double FingerSolid::signed_distance(double x, double rho) const {
  double best = std::numeric_limits<double>::infinity();
  const auto take = [&best](double d) {
    if (std::abs(d) < std::abs(best)) best = d;
  };
  // Flat of the tip.
  if (rho <= c_.rho_o) take(-c_.h_f - x);
  // Corner arc: the nearest point has the direction of (x, rho) from its centre, if that lies between phi and 90 deg.
  {
    const double u = c_.x_o - x, v = rho - c_.rho_o, d = std::hypot(u, v);
    if (v >= 0 && u * c_.cos_phi - v * c_.sin_phi >= 0) take(d - c_.r_t);
  }
  // Straight BC.
  {
    const double t = (x - c_.x_C) * c_.cos_phi + (rho - c_.rho_C) * c_.sin_phi;
    if (t <= 0 && t >= c_.p_B - c_.p_C) take(-(x - c_.x_C) * c_.sin_phi + (rho - c_.rho_C) * c_.cos_phi);
  }
  // Involute CD: foot of the perpendicular, f = (P - Q) . t = 0. The profile is hollow with radius r_vb tan(alpha_k).
  {
    double p = std::clamp((x * c_.cos_a + (rho - c_.r_0) * c_.sin_a) / c_.sin_a, c_.p_C, c_.p_D);
    double normal = 0;
    bool foot = false;
    for (int k = 0; k < 60; ++k) {
      const auto q = c_.involute(p);
      const double dx = x - q.x, dr = rho - q.rho;
      const double f = dx * q.cos_psi + dr * q.sin_psi;
      normal = -dx * q.sin_psi + dr * q.cos_psi;
      const double slope = -q.dS + normal * q.dpsi;
      if (!(slope < 0)) break;
      const double next = std::clamp(p - f / slope, c_.p_C, c_.p_D);
      const double step = next - p;
      p = next;
      if (std::abs(step) <= 1e-13 * (1 + c_.r_0)) {
        const auto s = c_.involute(p);
        normal = -(x - s.x) * s.sin_psi + (rho - s.rho) * s.cos_psi;
        foot = std::abs((x - s.x) * s.cos_psi + (rho - s.rho) * s.sin_psi) <= 1e-9 * (1 + c_.r_0);
        break;
      }
    }
    if (foot) take(normal);
  }
  // Cylinder and the edge D, which is convex: a point whose nearest point is the edge lies outside.
  if (x >= c_.x_D) take(rho - c_.rho_D);
  const double edge = std::hypot(x - c_.x_D, rho - c_.rho_D);
  if (edge < std::abs(best)) best = edge;
  // Far from every foot (deep inside, beyond the centre of curvature): the ends of the pieces bound the distance.
  if (!std::isfinite(best) || (edge <= std::abs(best) && x < c_.x_D)) {
    const bool inside = x >= -c_.h_f && rho <= radius(x);
    const double distance = std::min({edge, std::hypot(x - c_.x_C, rho - c_.rho_C),
                                      std::hypot(x - c_.x_B, rho - c_.rho_B), std::hypot(x + c_.h_f, rho - c_.rho_o)});
    return inside ? -distance : distance;
  }
  return best;
}

}  // namespace toothpath::bevel_gear
