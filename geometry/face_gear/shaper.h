// The involute shaper (or pinion) that generates a face gear: its transverse profile as a support function.
//
// A profile point of side s (+1, -1) at normal angle A is  h e(sA) - s g t(sA), its normal into the shaper body s
// t(sA), with e(x) = cos x d + sin x b, t(x) = -sin x d + cos x b in the shaper's transverse plane (d, b). See
// docs/face_gear.md.
#pragma once

#include <cmath>

#include "geometry/face_gear/parameters.h"

namespace toothpath::face_gear {

/// Dimensions of a shaper with rounded or sharp tooth tips. Lengths mm, angles rad.
template <typename S>
struct InvoluteShaper {
  int teeth = 0;
  S m_t{}, alpha_t{};              ///< transverse module and pressure angle
  S r_p{}, r_b{}, r_a{};           ///< pitch, base and tip radius
  S kappa{};                       ///< tan(beta)/r_p: twist per mm of axis; 0 for a spur gear
  S beta_b{}, sin_bb{}, cos_bb{};  ///< base helix angle, signed
  S T{};                           ///< kappa r_b = tan(beta_b)
  S theta_0{};                     ///< half tooth-space angle at the base circle
  S rho{}, r_c{};                  ///< tip rounding and radius of the circle of its centres
  S theta_t{};                     ///< roll parameter at the end of the involute
  S A_t{}, A_e{}, psi_c{};         ///< normal angle at start and end of the rounding, polar angle of its centre
  S h_a{}, h_f{};                  ///< gear: addendum h_a* m; dedendum (h_a* + c*) m

  /// Support h and length g of the tip rounding at normal angle A in [A_t, A_e].
  [[nodiscard]] S rounding_h(const S& A) const {
    using std::cos;
    return r_c * cos(S(A - psi_c));
  }
  [[nodiscard]] S rounding_g(const S& A) const {
    using std::sin;
    return rho + r_c * sin(S(A - psi_c));
  }
};

/// Shaper of one zone. Preconditions (checked by `check_shaper`): r_c >= r_b, psi_c <= pi/N_s.
/// Source: ISO 21771 involute relations; tip rounding as a circle in the transverse plane.
template <typename S>
InvoluteShaper<S> make_shaper(const FaceGearParameters& gear, double helix_angle_rad) {
  using std::atan, std::atan2, std::cos, std::sin, std::sqrt, std::tan;
  InvoluteShaper<S> w;
  w.teeth = gear.shaper_teeth;
  const S m(gear.module_mm), alpha(gear.pressure_angle_rad), beta(helix_angle_rad), N_s(gear.shaper_teeth);
  const S pi = S(4) * atan(S(1));
  if (gear.module_plane == ModulePlane::normal) {
    w.m_t = m / cos(beta);
    w.alpha_t = atan(S(tan(alpha) / cos(beta)));
  } else {
    w.m_t = m;
    w.alpha_t = alpha;
  }
  w.h_a = S(gear.addendum_coefficient) * m;
  w.h_f = S(gear.addendum_coefficient + gear.clearance_coefficient) * m;
  w.r_p = w.m_t * N_s / S(2);
  w.r_b = w.r_p * cos(w.alpha_t);
  w.r_a = w.r_p + w.h_f;
  w.kappa = tan(beta) / w.r_p;
  w.T = w.kappa * w.r_b;
  w.beta_b = atan(w.T);
  w.cos_bb = S(1) / sqrt(S(S(1) + w.T * w.T));
  w.sin_bb = w.T * w.cos_bb;
  const S inv_alpha = tan(w.alpha_t) - w.alpha_t;
  w.theta_0 = pi / (S(2) * N_s) - inv_alpha - S(gear.backlash_mm) / (S(2) * w.r_b * w.cos_bb);
  w.rho = S(gear.shaper_tip_radius_mm);
  w.r_c = w.r_a - w.rho;
  const S root = w.r_c * w.r_c - w.r_b * w.r_b;
  const S tau = w.rho + sqrt(root);
  w.theta_t = tau / w.r_b;
  w.A_t = w.theta_0 + w.theta_t;
  w.psi_c = w.A_t - atan2(S(tau - w.rho), w.r_b);
  w.A_e = w.psi_c + pi / S(2);
  return w;
}

/// Refuses a shaper whose tip is pointed, whose rounding is too large, or that has no involute at its tip.
[[nodiscard]] Status check_shaper(const FaceGearParameters& gear, double helix_angle_rad);

/// The largest tip rounding that the shaper can carry (full round tip), mm.
/// 0 when the sharp tooth is pointed already.
[[nodiscard]] double largest_tip_radius(const FaceGearParameters& gear, double helix_angle_rad);

/// Roll parameter theta_act at which the active flank ends: tip circle of a pinion equal to the shaper, rad.
[[nodiscard]] double active_roll_parameter(const FaceGearParameters& gear, double helix_angle_rad);

/// The largest tip rounding that still leaves the whole active flank, theta_t >= theta_act, mm.
[[nodiscard]] double largest_active_tip_radius(const FaceGearParameters& gear, double helix_angle_rad);

}  // namespace toothpath::face_gear
