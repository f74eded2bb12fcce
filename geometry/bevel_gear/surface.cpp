#include "geometry/bevel_gear/surface.h"

#include <Eigen/Dense>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace toothpath::bevel_gear {

namespace {
constexpr double kOneBranch = 1e-3;  // rad: a place is closed in by halves so far
}  // namespace

BevelCurvature bevel_curvature(const BevelWall<double>& w, double beta, double p) {
  const auto& t = w.trace;
  const double sd = t.sin_delta, cd = t.cos_delta, s = w.sigma;
  const auto q = w.cutter.at(p);
  const auto f = w.point(beta, p);
  const double sg = std::sin(f.gamma), cg = std::cos(f.gamma);
  const auto& c = f.centre;
  const bool straight = t.straight(w.sigma, beta);
  const double F = straight ? 1.0 : t.speed_ratio(w.sigma, beta), kappa = straight ? 0.0 : t.turn(w.sigma, beta),
               R_c = c.R_c, sb = std::sin(c.beta_c), cb = std::cos(c.beta_c);
  const double R_p = F * cb, e_p = F * sb / (R_c * sd), beta_p = kappa - F * sb / R_c;
  const double x_N = q.x + q.rho * q.sin_psi / q.cos_psi, tn = sb / cb;
  const double qq = 1 + x_N * cd / (R_c * sd), q_p = -x_N * R_p * cd / (R_c * R_c * sd);
  const double x_Np = q.dS / q.cos_psi + q.rho * q.dpsi / (q.cos_psi * q.cos_psi);
  const double den = 1 + tn * tn * qq * qq;
  const double g_s = ((1 + tn * tn) * qq * beta_p + tn * q_p) / den;
  const double g_p = tn * x_Np * cd / (R_c * sd) / den;

  const Vec3 a(-sd, 0, cd), k(0, 0, 1);
  const Vec3 e1(q.cos_psi, -s * q.sin_psi * cg, s * q.sin_psi * sg), e2(0, s * sg, s * cg);
  const Vec3 n(-q.sin_psi, -s * q.cos_psi * cg, s * q.cos_psi * sg);
  const Vec3 v = R_p * k + e_p * a.cross(Vec3(f.contact + R_c * k));
  Eigen::Matrix2d M, D;
  M << q.dS, v.dot(e1), q.rho * g_p, v.dot(e2) + q.rho * g_s;
  const Vec3 turn = e_p * a.cross(n);
  D << -q.dpsi, turn.dot(e1), q.cos_psi * g_p, turn.dot(e2) + q.cos_psi * g_s;
  const Eigen::Matrix2d W = D * M.inverse();
  BevelCurvature out;
  out.regularity = s * M.determinant() / q.dS;
  out.asymmetry = std::abs(W(0, 1) - W(1, 0));
  const double mean = 0.5 * (W(0, 0) + W(1, 1)), off = 0.5 * (W(0, 1) + W(1, 0));
  const double half = std::hypot(0.5 * (W(0, 0) - W(1, 1)), off);
  out.kappa_1 = mean + half;
  out.kappa_2 = mean - half;
  return out;
}

std::optional<BevelInverse> bevel_inverse(const BevelWall<double>& w, double ell, double height,
                                          const BevelInverse& start) {
  using D2 = Dual<double, 2>;
  const auto& c = w.cutter;
  const BevelWall<D2> dual = wall_over<D2>(w);

  const double scale = w.trace.R_0, half_pi = std::asin(1.0);
  // Steps are cut back: beta stays inside the trace, p inside the profile (a little beyond D on the involute).
  const double p_low = c.p_A, p_high = c.p_D + 0.25 * (c.p_D - c.p_A);
  // On the straight end of an eps = +1 path, which goes on for any negative parameter, ell is nearly linear; a unit may
  // be short there.
  const bool goes_on = w.eps() > 0 && w.trace.beta_end > 0;
  const double lowest = goes_on ? -1e4 : 0.0;
  double beta = start.beta, p = std::clamp(start.p, p_low + 1e-9 * (p_high - p_low), p_high);
  for (int n = 0; n < 60; ++n) {
    const Vec2T<D2> g = dual.generatrix(D2::variable(beta, 0), D2::variable(p, 1));
    const double f0 = g[0].v - ell, f1 = g[1].v - height;
    const double a = g[0].d[0], b = g[0].d[1], e = g[1].d[0], d = g[1].d[1];
    const double det = a * d - b * e;
    if (!(std::abs(det) > 0) || !std::isfinite(det)) return std::nullopt;
    double db = -(d * f0 - b * f1) / det, dp = -(a * f1 - e * f0) / det;
    const bool straight = goes_on && beta < w.trace.beta_end;
    const double farthest = straight ? 1e3 : 0.2,
                 highest = straight ? w.trace.beta_end + 0.2 : half_pi - 0.5 * (half_pi - beta);
    const double next_beta = std::clamp(beta + std::clamp(db, -farthest, farthest), lowest, highest);
    const double widest = 0.3 * (p_high - p_low);
    const double next_p = std::clamp(p + std::clamp(dp, -widest, widest), p_low, p_high);
    const double moved = std::abs(a * (next_beta - beta)) + std::abs(d * (next_p - p));
    beta = next_beta;
    p = next_p;
    if (moved > 1e-7 * scale) continue;  // Newton is square: the next step would be one of rounding
    const auto f = w.point(beta, p);
    const ConePoint at = cone_point(f.p, w.trace.sin_delta, w.trace.cos_delta);
    const double miss = std::hypot(at.ell - ell, at.height - height);
    if (miss > 1e-13 * scale && moved > 1e-13 * scale) continue;
    if (miss > 1e-10 * scale) return std::nullopt;
    const Vec3& q = f.contact;
    const double azimuth =
        f.centre.e + std::atan2(q.y(), q.x() * w.trace.cos_delta + (q.z() + f.centre.R_c) * w.trace.sin_delta);
    return BevelInverse{beta, p, azimuth, n + 1};
  }
  return std::nullopt;
}

std::optional<double> bevel_beta_at(const BevelWall<double>& w, double ell, double p) {
  // The contact lies within the cutter's radius of its centre, the centre within r_0 of the trace.
  const double lowest = std::max(ell - 3 * w.cutter.rho_D, 0.3 * ell);
  double lo = 0.0, hi = w.trace.beta(std::min(lowest, w.trace.R_0));
  // The straight end of an eps = +1 path goes on for any negative parameter; near beta_e = 0 a unit of it is short.
  if (w.eps() > 0 && w.trace.beta_end > 0)
    for (lo = -0.5; lo > -1e4 && w.generatrix(lo, p)[0] < ell;) lo *= 2;
  // Just before the end of the trace ell may turn back (convex wall, tip): the bracket starts on the falling branch.
  for (int k = 1; k <= 400 && w.generatrix(lo, p)[0] < ell; ++k) lo = 0.2 * k / 400;
  const auto beyond = [&](double beta) { return w.generatrix(beta, p)[0] - ell; };
  double at_lo = beyond(lo), at_hi = beyond(hi);
  if (!(at_lo >= 0 && at_hi <= 0)) return std::nullopt;
  // Where ell turns back there may be three places: halves lead to the branch of the rest of the wall.
  while (std::abs(hi - lo) > kOneBranch) {
    const double mid = 0.5 * (lo + hi), at_mid = beyond(mid);
    (at_mid > 0 ? lo : hi) = mid, (at_mid > 0 ? at_lo : at_hi) = at_mid;
  }
  if (lo == hi || at_lo == 0) return lo;
  std::uintmax_t rounds = 100;
  const bool rising = lo > hi;
  const auto between =
      boost::math::tools::toms748_solve(beyond, rising ? hi : lo, rising ? lo : hi, rising ? at_hi : at_lo,
                                        rising ? at_lo : at_hi, boost::math::tools::eps_tolerance<double>(), rounds);
  return 0.5 * (between.first + between.second);
}

namespace {

/// A start on the branch that the wall lies on, where ell turns back near the end of the trace: the height rises with p
/// at one cone distance.
std::optional<BevelInverse> start_by_bisection(const BevelWall<double>& w, double ell, double height) {
  BevelInverse at;
  const auto height_at = [&](double p) -> std::optional<double> {
    const auto beta = bevel_beta_at(w, ell, p);
    if (!beta) return std::nullopt;
    at.beta = *beta, at.p = p;
    return w.generatrix(*beta, p)[1];
  };
  double low = w.cutter.p_A, high = w.cutter.p_D;
  const auto least = height_at(low), most = height_at(high);
  if (!least || !most || *least > height || *most < height) return std::nullopt;
  for (int k = 0; k < 40; ++k) {
    const double mid = 0.5 * (low + high);
    const auto there = height_at(mid);
    if (!there) return std::nullopt;
    (*there < height ? low : high) = mid;
  }
  return at;
}

}  // namespace

std::optional<BevelInverse> bevel_inverse(const BevelWall<double>& w, double ell, double height) {
  BevelInverse start;
  start.beta = std::max({w.trace.beta(std::min(ell, w.trace.R_0)), 1e-3, w.eps() > 0 ? w.trace.beta_end : 0.0});
  // p of the profile point at this height: exact on arc and straight, Newton on the involute.
  const auto& c = w.cutter;
  if (height >= c.x_C) {
    start.p = std::max(c.p_C, height / (c.sin_a * c.cos_a));
    for (int k = 0; k < 8; ++k) {
      const auto q = c.flank(start.p);
      if (!(q.dS > 0)) break;
      start.p = std::max(c.p_C, start.p - (q.x - height) / (q.dS * q.cos_psi));
    }
  } else if (height >= c.x_B) {
    start.p = c.p_C + (height - c.x_C) / c.cos_phi;
  } else {
    const double s = std::clamp((c.x_o - height) / c.r_t, -1.0, 1.0);
    start.p = c.p_B - c.r_t * (std::asin(s) - c.phi);
  }
  if (const auto found = bevel_inverse(w, ell, height, start)) return found;
  const auto bracketed = start_by_bisection(w, ell, height);
  return bracketed ? bevel_inverse(w, ell, height, *bracketed) : std::nullopt;
}

}  // namespace toothpath::bevel_gear
