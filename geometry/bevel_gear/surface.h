// Flank of the equal-base-circle bevel gear: the envelope of the finger mill, in closed form.
//
// The surface normal meets the cutter axis at x_N = x + rho tan(psi); the profile point touches the envelope where that
// point moves at right angles to the normal. Parameters: beta (where along the trace), p (where on the profile);
// nothing is iterated. Normals point out of the material, into the tooth space. Derivation: docs/bevel_gear.md,
// section 5.
#pragma once

#include <optional>

#include "geometry/base/dual.h"
#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::bevel_gear {

template <typename S>
struct BevelFlankPoint {
  Vec3T<S> p, n;     ///< blank frame
  Vec3T<S> contact;  ///< cutter frame
  CutterCentre<S> centre;
  S gamma{};  ///< azimuth of the contact on the cutter, rad
};

/// Second order of the envelope.
struct BevelCurvature {
  double regularity = 0;            ///< J_n: 1 nominal, <= 0 where the envelope is not the boundary (undercut)
  double kappa_1 = 0, kappa_2 = 0;  ///< principal curvatures, positive: hollow flank; kappa_1 >= kappa_2
  double asymmetry = 0;             ///< |W_12 - W_21|, rounding only
};

/// Generatrix coordinates of a flank point and where it came from.
struct BevelInverse {
  double beta = 0, p = 0;
  double azimuth = 0;  ///< of the wall at (ell, height)
  int iterations = 0;
};

/// One wall of one half.
template <typename S>
struct BevelWall {
  BevelTrace<S> trace;
  FingerProfile<S> cutter;
  int sigma = 1;

  [[nodiscard]] int eps() const { return -sigma * trace.h; }

  /// Point of the envelope; 0 < beta < pi/2 (0 allowed), p_A <= p.
  [[nodiscard]] BevelFlankPoint<S> point(const S& beta, const S& p) const {
    return point_at(trace.centre(sigma, beta), cutter.at(p));
  }

  [[nodiscard]] BevelFlankPoint<S> point_at(const CutterCentre<S>& c, const ProfilePoint<S>& q) const {
    using std::sin, std::cos, std::atan2;
    const S sd = trace.sin_delta, cd = trace.cos_delta;
    const S d = c.R_c * sd * q.cos_psi;
    const S gamma = atan2(S(sin(c.beta_c) * (d + cd * (q.x * q.cos_psi + q.rho * q.sin_psi))), S(cos(c.beta_c) * d));
    const S sg = sin(gamma), cg = cos(gamma), s = S(sigma);
    BevelFlankPoint<S> f;
    f.centre = c;
    f.gamma = gamma;
    f.contact = {q.x, S(-s * q.rho * cg), S(s * q.rho * sg)};
    f.p = blank_from_cutter<S>(f.contact[0], f.contact[1], f.contact[2], c.R_c, c.e, sd, cd);
    const S nx = q.sin_psi, ny = s * q.cos_psi * cg, nz = -s * q.cos_psi * sg;
    const S m = nx * cd + nz * sd, ce = cos(c.e), se = sin(c.e);
    f.n = {S(m * ce - ny * se), S(m * se + ny * ce), S(nz * cd - nx * sd)};
    return f;
  }

  /// (ell, height) of the envelope without the azimuth; cheaper than `point` and free of the trace's winding.
  [[nodiscard]] Vec2T<S> generatrix(const S& beta, const S& p) const {
    using std::sin, std::cos, std::atan2, std::sqrt;
    const S sd = trace.sin_delta, cd = trace.cos_delta;
    const CutterCentre<S> c = trace.centre(sigma, beta);
    const ProfilePoint<S> q = cutter.at(p);
    const S d = c.R_c * sd * q.cos_psi;
    const S gamma = atan2(S(sin(c.beta_c) * (d + cd * (q.x * q.cos_psi + q.rho * q.sin_psi))), S(cos(c.beta_c) * d));
    const S y = S(-sigma) * q.rho * cos(gamma), z = S(sigma) * q.rho * sin(gamma);
    const S a = q.x * cd + (z + c.R_c) * sd;
    const S r = sqrt(S(a * a + y * y));
    const S lift = a > S(0) ? S(y * y / (r + a)) : S(r - a);
    return {S(z + c.R_c + lift * sd), S(q.x + lift * cd)};
  }
};

/// The wall for another scalar.
template <typename S>
[[nodiscard]] BevelWall<S> wall_over(const BevelWall<double>& w) {
  BevelWall<S> out;
  out.sigma = w.sigma;
  auto& t = out.trace;
  t.R_0 = w.trace.R_0, t.sin_delta = w.trace.sin_delta, t.cos_delta = w.trace.cos_delta;
  t.beta_ref = w.trace.beta_ref, t.r_0 = w.trace.r_0, t.e_h = w.trace.e_h, t.h = w.trace.h;
  t.beta_end = w.trace.beta_end;
  for (int k = 0; k < 2; ++k) t.lead[k] = w.trace.lead[k];
  const auto& c = w.cutter;
  FingerProfile<S>& k = out.cutter;
  k.sin_a = c.sin_a, k.cos_a = c.cos_a, k.alpha_n = c.alpha_n, k.kappa_v = c.kappa_v, k.r_0 = c.r_0, k.h_f = c.h_f;
  k.r_t = c.r_t, k.p_C = c.p_C, k.p_B = c.p_B, k.p_A = c.p_A, k.p_D = c.p_D, k.phi = c.phi, k.sin_phi = c.sin_phi;
  k.cos_phi = c.cos_phi, k.x_C = c.x_C, k.rho_C = c.rho_C, k.x_B = c.x_B, k.rho_B = c.rho_B, k.x_o = c.x_o;
  k.rho_o = c.rho_o, k.x_D = c.x_D, k.rho_D = c.rho_D, k.law = c.law, k.plain_p_C = c.plain_p_C;
  k.plain_x_C = c.plain_x_C, k.plain_rho_C = c.plain_rho_C, k.plain_sin_phi = c.plain_sin_phi;
  k.plain_cos_phi = c.plain_cos_phi;
  return out;
}

/// J_n and the curvatures at (beta, p); psi < 90 deg, F != 0.
[[nodiscard]] BevelCurvature bevel_curvature(const BevelWall<double>& wall, double beta, double p);

/// Flank parameters of the point at (ell, height): Newton, 4..7 steps, until the wall misses it by less than 1e-13 of
/// R_0 or steps are as small. Empty where it has no such point (outside the trace or the profile, or no convergence).
[[nodiscard]] std::optional<BevelInverse> bevel_inverse(const BevelWall<double>& wall, double ell, double height);
/// The same, started from a neighbour.
[[nodiscard]] std::optional<BevelInverse> bevel_inverse(const BevelWall<double>& wall, double ell, double height,
                                                        const BevelInverse& start);

/// Spiral angle at which profile point p touches the wall at cone distance ell, to rounding; ell falls with beta. Empty
/// outside the trace.
[[nodiscard]] std::optional<double> bevel_beta_at(const BevelWall<double>& wall, double ell, double p);

}  // namespace toothpath::bevel_gear
