#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::bevel_gear {

namespace {

constexpr int kBendLooks = 8;        // a smooth piece of a modified flank is looked at in so many places
constexpr double kBendMargin = 1.1;  // what its bend may be between them
/// Of 1 + r_0: behind so short a step of Newton, what is sought is known to rounding.
constexpr double kLastStep = 1e-8;
constexpr double kSteep = 0.01;  // a root is plain where the slope is above

/// Place of the plain flank at this depth below the tip.
double place_at_depth(const FingerProfile<double>& c, double depth) {
  const double x = c.law->tip_mm - depth;
  if (x <= c.plain_x_C) return c.plain_p_C + (x - c.plain_x_C) / c.plain_cos_phi;
  double low = c.plain_p_C, high = std::max(c.p_D, low) + 1;
  while (c.involute(high).x < x) high += high - low;
  for (int k = 0; k < 100; ++k) {
    const double mid = 0.5 * (low + high);
    (c.involute(mid).x < x ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

/// Largest arc length times turn per square of p between two places.
double bend_between(const FingerProfile<double>& c, double from, double to) {
  double most = 0;
  for (int k = 0; k < kBendLooks; ++k) {
    const auto q = c.flank(from + (to - from) * (k + 0.5) / kBendLooks);
    most = std::max(most, std::abs(q.dS * q.dpsi));
  }
  return kBendMargin * most;
}

/// Signed distance of a meridian point to the involute CD (or the flank of its law), where a foot of the perpendicular
/// lies on it: f = (P - Q) . t = 0. The profile is hollow with radius r_vb tan(alpha_k).
std::optional<double> above_flank(const FingerProfile<double>& c, double x, double rho) {
  double p = std::clamp((x * c.cos_a + (rho - c.r_0) * c.sin_a) / c.sin_a, c.p_C, c.p_D);
  double low = c.p_C, high = c.p_D;
  for (int k = 0; k < 60; ++k) {
    const auto q = c.flank(p);
    const double dx = x - q.x, dr = rho - q.rho;
    const double f = dx * q.cos_psi + dr * q.sin_psi, normal = -dx * q.sin_psi + dr * q.cos_psi;
    const double slope = -q.dS + normal * q.dpsi;
    if (!(slope < 0)) return {};
    const double newton = p - f / slope;
    double next = std::clamp(newton, c.p_C, c.p_D);
    // The distance changes by f times the turn of the normal: by nothing.
    if (!c.law && next == newton && std::abs(next - p) <= kLastStep * (1 + c.r_0)) return normal;
    if (c.law) {  // its bend jumps: the foot stays between what was found on both sides of it
      (f > 0 ? low : high) = p;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
    }
    const double step = next - p;
    p = next;
    if (std::abs(step) > 1e-13 * (1 + c.r_0)) continue;
    const auto s = c.flank(p);
    if (std::abs((x - s.x) * s.cos_psi + (rho - s.rho) * s.sin_psi) > 1e-9 * (1 + c.r_0)) return {};
    return -(x - s.x) * s.sin_psi + (rho - s.rho) * s.cos_psi;
  }
  return {};
}

}  // namespace

std::vector<double> flank_joints(const FingerProfile<double>& c) {
  std::vector<double> at{c.p_C, c.p_D};
  if (c.law) {
    at.push_back(c.plain_p_C);
    for (const auto& curve : c.law->removed.curves)
      for (const double depth : curve.knots()) at.push_back(place_at_depth(c, depth));
    std::erase_if(at, [&](double p) { return p < c.p_C || p > c.p_D; });
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
  }
  return at;
}

std::vector<double> flank_steps(const FingerProfile<double>& c, double chord_mm) {
  const std::vector<double> joints = flank_joints(c);
  std::vector<double> out{joints.front()};
  for (std::size_t i = 1; i < joints.size(); ++i) {
    // The involute turns by kappa_v per p and has the radius dS/dpsi, largest at D: equal steps of p keep the bound of
    // the last.
    const double from = joints[i - 1], to = joints[i], length = to - from,
                 bend = c.law ? bend_between(c, from, to) : c.involute(to).dS * c.kappa_v;
    const int steps = std::max(1, static_cast<int>(std::ceil(length * std::sqrt(bend / (8 * chord_mm)))));
    for (int k = 1; k <= steps; ++k) out.push_back(k == steps ? to : from + length * k / steps);
  }
  return out;
}

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
    const auto q = c_.flank(p);
    const double step = (q.x - x) / (q.dS * q.cos_psi);
    p = std::clamp(p - step, c_.p_C, c_.p_D);
    if (std::abs(step) < 1e-14 * (1 + c_.r_0)) break;
  }
  return c_.flank(p).rho;
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
    const auto q = c_.flank(p);
    (q.rho < rho ? lo : hi) = p;
    const double slope = q.dS * q.sin_psi, newton = p - (q.rho - rho) / slope;
    const double next = slope > 0 && newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
    if (!c_.law && slope > kSteep && next == newton && std::abs(next - p) <= kLastStep * (1 + c_.r_0))
      return q.x + (next - p) * q.dS * q.cos_psi;
    if (std::abs(next - p) <= 1e-14 * (1 + c_.r_0)) break;
    p = next;
  }
  return c_.flank(p).x;
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
  if (const auto d = above_flank(c_, x, rho)) take(*d);
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
