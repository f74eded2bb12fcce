#include "cam/finger_passes.h"

#include <algorithm>
#include <cmath>

#include "cam/finger_reference.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kRidgeShare = 0.85;  // of the allowed ridge that the planner uses
constexpr double kClearAir = 1.0;     // mm, between cutter and blank beyond the large end

using Centre = CutterCentre<double>;
using Trace = BevelTrace<double>;

const Trace& trace_of(const BevelGear& gear, std::size_t half) { return gear.halves()[half].walls[0].trace; }

/// Straight run-out at the large end until the cutter has left the blank.
void run_out(const BevelGear& gear, std::size_t half, CentrePass& pass) {
  if (half + 1 != gear.halves().size()) return;
  const Trace t = trace_of(gear, half);
  const Centre end = pass.pieces.back().at(1.0);
  const double want = gear.R_e() + gear.cutter().rho_D + kClearAir;
  if (end.R_c >= want) return;
  double length = want - end.R_c;
  for (int k = 0; k < 60; ++k) {
    const Centre c = t.run_straight(end, length);
    if (std::abs(c.R_c - want) < 1e-9) break;
    length += (want - c.R_c) / std::max(0.2, std::cos(c.beta_c));
  }
  pass.pieces.push_back({static_cast<int>(half), [t, end, length](double s) { return t.run_straight(end, s * length); }});
}

/// The pieces of one wall in one half, run-out included.
void add_wall(const BevelGear& gear, std::size_t i, int sigma, CentrePass& pass) {
  const BevelHalf& half = gear.halves()[i];
  const int k = sigma > 0 ? 0 : 1;
  const Trace t = half.walls[k].trace;
  const auto add = [&](double from, double to) {
    pass.pieces.push_back({static_cast<int>(i), [t, sigma, from, to](double s) { return t.centre(sigma, from + (to - from) * s); }});
  };
  const double from = half.beta_from[k], to = half.beta_to[k];
  // The path changes from curve to tangent at beta_end: a joint between pieces.
  if (-sigma * half.hand > 0 && to < t.beta_end && from > t.beta_end) {
    add(from, t.beta_end);
    add(t.beta_end, to);
  } else {
    add(from, to);
  }
  run_out(gear, i, pass);
}

CentrePass wall_pass(int sigma, bool climb) {
  CentrePass pass;
  pass.name = sigma > 0 ? "wall L" : "wall U";
  // Material lies at lower azimuth of wall L: on the left of an outward feed, seen from the shank.
  pass.outward = (sigma < 0) == climb;
  return pass;
}

/// Where the trace begins to lie between both wall paths, from `from` on towards `to`: at the small end of a gear with few teeth they close before it.
double first_between(const BevelGear& gear, const Trace& t, double from, double to) {
  const WallReference L(gear, 1), U(gear, -1);
  const auto between = [&](double beta) {
    const Centre c = t.middle(beta);
    return L.offset(c.R_c, c.theta_c) >= 0 && U.offset(c.R_c, c.theta_c) >= 0;
  };
  if (between(from)) return from;
  constexpr int kLooks = 64;
  for (int k = 1; k <= kLooks; ++k) {
    double inside = from + (to - from) * k / kLooks, outside = from + (to - from) * (k - 1) / kLooks;
    if (!between(inside)) continue;
    for (int n = 0; n < 40; ++n) {
      const double mid = 0.5 * (inside + outside);
      (between(mid) ? inside : outside) = mid;
    }
    return inside;
  }
  return from;
}

CentrePass middle(const BevelGear& gear, std::size_t i) {
  const BevelHalf& half = gear.halves()[i];
  const Trace t = trace_of(gear, i);
  const double begin = t.beta(half.R_from), to = t.beta(std::min(half.R_to, t.R_lim())), from = i == 0 ? first_between(gear, t, begin, to) : begin;
  CentrePass pass;
  pass.name = "middle";
  pass.pieces.push_back({static_cast<int>(i), [t, from, to](double s) { return t.middle(from + (to - from) * s); }});
  run_out(gear, i, pass);
  return pass;
}

/// Trace parameters that both walls' passes of a half have in common, and the middle too.
std::pair<double, double> common(const BevelGear& gear, std::size_t i) {
  const BevelHalf& half = gear.halves()[i];
  const Trace& t = trace_of(gear, i);
  const double from = std::min({half.beta_from[0], half.beta_from[1], t.beta(half.R_from)});
  const double to = std::max({half.beta_to[0], half.beta_to[1], t.beta(std::min(half.R_to, t.R_lim())), t.beta_end});
  return {from, to};
}

/// Between the walls: polar blend of both wall paths at the same trace parameter, mu in (-1, 1), -1 = wall L.
Centre blend(const Trace& t, double beta, double mu) {
  const Centre L = t.centre(1, beta), U = t.centre(-1, beta);
  const double a = 0.5 * (1 - mu), b = 0.5 * (1 + mu);
  Centre c;
  c.R_c = a * L.R_c + b * U.R_c;
  c.theta_c = a * L.theta_c + b * U.theta_c;
  c.e = c.theta_c / t.sin_delta;
  const double f_L = t.speed_ratio(1, beta), f_U = t.speed_ratio(-1, beta);
  const double dR = a * f_L * std::cos(L.beta_c) + b * f_U * std::cos(U.beta_c);
  const double dT = a * f_L * std::sin(L.beta_c) / L.R_c + b * f_U * std::sin(U.beta_c) / U.R_c;
  c.beta_c = std::atan2(c.R_c * dT, dR);
  return c;
}

CentrePass fill(const BevelGear& gear, std::size_t i, double mu, double from, double to) {
  const Trace t = trace_of(gear, i);
  CentrePass pass;
  pass.name = fmt::format("fill {:.2f}", mu);
  pass.pieces.push_back({static_cast<int>(i), [t, mu, from, to](double s) { return blend(t, from + (to - from) * s, mu); }});
  run_out(gear, i, pass);
  return pass;
}

/// Gaps between the middle and one wall that the allowed ridge asks for, at trace parameter beta.
int gaps(const BevelGear& gear, std::size_t i, double beta, double ridge_mm) {
  const Trace& t = trace_of(gear, i);
  const double allowed = finger_gap(gear, t.R(beta), kRidgeShare * ridge_mm);
  return std::max(1, static_cast<int>(std::ceil(0.5 * crown_distance(t.centre(1, beta), t.centre(-1, beta)) / allowed)));
}

/// Height above the root cone of the lower surface of the cutter at lateral distance y.
double surface_height(const BevelGear& gear, const FingerSolid& solid, double R_c, double y) {
  const double x = solid.lower_surface(y), a = x * gear.cos_delta() + R_c * gear.sin_delta();
  return x + y * y / (std::hypot(a, y) + a) * gear.cos_delta() + gear.parameters().dedendum_mm;
}

}  // namespace

double crown_distance(const Centre& a, const Centre& b) {
  const double d = b.theta_c - a.theta_c, s = std::sin(0.5 * d);
  return std::sqrt((b.R_c - a.R_c) * (b.R_c - a.R_c) + 4 * a.R_c * b.R_c * s * s);
}

CutterCentre<double> corner_arc(const BevelGear& gear, double t) {
  const int sigma = -gear.corner().sigma;
  const double R_J = gear.R_ref(), r_0 = gear.cutter().r_0, beta_J = trace_of(gear, 0).beta(R_J);
  const double corner = -sigma * gear.e_h() * gear.sin_delta();
  // Direction from the corner of the trace to the centre, measured from the ray through it.
  const double direction = sigma * (kPi / 2 + beta_J * (1 - 2 * t));
  const double turn = std::atan2(r_0 * std::sin(direction), R_J + r_0 * std::cos(direction));
  Centre c;
  c.R_c = std::hypot(R_J + r_0 * std::cos(direction), r_0 * std::sin(direction));
  c.theta_c = corner + turn;
  c.e = c.theta_c / gear.sin_delta();
  c.beta_c = direction - sigma * kPi / 2 - turn;
  return c;
}

std::vector<CentrePass> roughing_passes(const BevelGear& gear, double ridge_mm, double& predicted_mm) {
  std::vector<CentrePass> passes;
  predicted_mm = 0;
  for (std::size_t n = gear.halves().size(); n-- > 0;) {
    passes.push_back(middle(gear, n));
    const auto [from, to] = common(gear, n);
    const int most = std::max(gaps(gear, n, to, ridge_mm), gaps(gear, n, from, ridge_mm));
    for (int k = 1; k < most; ++k)
      for (const int side : {-1, 1}) passes.push_back(fill(gear, n, side * static_cast<double>(k) / most, from, to));
    const Trace& t = trace_of(gear, n);
    for (int s = 0; s <= 32; ++s) {
      const double beta = from + (to - from) * s / 32.0;
      predicted_mm = std::max(predicted_mm, finger_ridge(gear, t.R(beta), 0.5 * crown_distance(t.centre(1, beta), t.centre(-1, beta)) / most));
    }
  }
  return passes;
}

std::vector<CentrePass> wall_passes(const BevelGear& gear, bool climb) {
  std::vector<CentrePass> passes;
  for (const int sigma : {1, -1}) {
    CentrePass pass = wall_pass(sigma, climb);
    if (gear.herringbone() && sigma == gear.corner().sigma) {
      // Concave: the crossing is the end of both.
      CentrePass outer = pass;
      add_wall(gear, 1, sigma, outer);
      add_wall(gear, 0, sigma, pass);
      passes.push_back(std::move(outer));
    } else if (gear.herringbone()) {
      add_wall(gear, 0, sigma, pass);
      pass.pieces.push_back({1, [gear](double t) { return corner_arc(gear, t); }});
      add_wall(gear, 1, sigma, pass);
    } else {
      add_wall(gear, 0, sigma, pass);
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

double finger_ridge(const BevelGear& gear, double R_c, double gap) {
  return surface_height(gear, FingerSolid(gear.cutter()), R_c, 0.5 * gap);
}

double finger_gap(const BevelGear& gear, double R_c, double ridge) {
  const FingerSolid solid(gear.cutter());
  double lo = 0, hi = gear.cutter().rho_D;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (lo + hi);
    (surface_height(gear, solid, R_c, mid) < ridge ? lo : hi) = mid;
  }
  return 2 * lo;
}

}  // namespace toothpath
