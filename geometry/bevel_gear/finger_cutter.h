// Profile of the finger mill: the tooth space of the equivalent gear, with a straight, an arc and a flat at the tip.
//
// Meridian plane (x, rho): x along the cutter axis from the pitch cone towards the shank, rho the radius. From the tip:
// flat (x = -h_f, rho <= rho_A), corner arc AB (radius r_t), straight BC, involute CD, cylinder from D on. G1 but at D.
// One running parameter p [mm] covers A..D: on the involute it is the arc parameter with p = 0 on the pitch circle,
// below C it is plain arc length. With a modification the flank C..D is the plain one moved along its normals: C lies
// where the modification has no bend any more, and the straight is the tangent there. psi is the inclination of the
// profile against the axis. mm and rad. Derivation: docs/bevel_gear.md, section 4.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "geometry/bevel_gear/flank_law.h"
#include "geometry/bevel_gear/parameters.h"
#include "geometry/bevel_gear/trace.h"

namespace toothpath::bevel_gear {

/// sin(u)/u, relative error below 2 eps.
template <typename S>
S sinc(const S& u) {
  using std::sin;
  if constexpr (kEncloses<S>) {
    // The series up to where |u| = 1 is told to 1e-18.
    const S q = u * u;
    S sum(1);
    for (int k = 9; k > 0; --k) sum = S(1) - q * sum / S(2.0 * k * (2 * k + 1));
    return sum;
  } else if constexpr (bevel_detail::kSeriesSuffices<S>) {
    if (bevel_detail::magnitude(u) < S(0.02)) {
      const S q = u * u;
      return S(1) - q * S(1.0 / 6) * (S(1) - q * S(1.0 / 20) * (S(1) - q * S(1.0 / 42)));
    }
  } else if (u == S(0)) {
    return S(1);
  }
  return sin(u) / u;
}

/// A profile point with what the envelope needs.
template <typename S>
struct ProfilePoint {
  S x{}, rho{};
  S sin_psi{}, cos_psi{};
  S dpsi{};  ///< d psi / dp
  S dS{};    ///< arc length per p
};

template <typename S>
struct FingerProfile {
  S sin_a{}, cos_a{}, alpha_n{};
  S kappa_v{};  ///< curvature of the equivalent pitch circle; 0 for a crown wheel
  S r_0{}, h_f{}, r_t{};
  S p_C{}, p_B{}, p_A{}, p_D{};
  S phi{}, sin_phi{}, cos_phi{};
  S x_C{}, rho_C{}, x_B{}, rho_B{};
  S x_o{}, rho_o{};  ///< centre of the corner arc; rho_A = rho_o
  S x_D{}, rho_D{};
  bool base_circle_clips_C = false;       ///< C wanted to lie inside the base circle: h_C is not reached
  std::shared_ptr<const ProfileLaw> law;  ///< what is taken off the plain flank; null: nothing
  /// Of the plain profile: where the involute ends, and the straight goes on along its tangent.
  S plain_p_C{}, plain_x_C{}, plain_rho_C{}, plain_sin_phi{}, plain_cos_phi{};

  /// Point of the involute branch, valid where tan(alpha_n) + kappa_v p >= 0.
  [[nodiscard]] ProfilePoint<S> involute(const S& p) const {
    using std::sin, std::cos;
    const S w = kappa_v * (r_0 + p), psi = alpha_n + w, half = sinc(S(w / S(2)));
    ProfilePoint<S> q;
    q.sin_psi = sin(psi);
    q.cos_psi = cos(psi);
    q.x = -kappa_v / S(2) * (r_0 + p) * (r_0 + p) * half * half + p * cos_a * q.sin_psi;
    q.rho = (r_0 + p) * sinc(w) - p * cos_a * q.cos_psi;
    q.dpsi = kappa_v;
    q.dS = cos_a * (sin_a / cos_a + kappa_v * p);
    return q;
  }
  /// Point of the flank above C: the involute, or what its modification makes of it.
  [[nodiscard]] ProfilePoint<S> flank(const S& p) const { return flank(p, !(p < plain_p_C)); }
  /// The same where the plain flank is the involute, and where it is the straight below it.
  [[nodiscard]] ProfilePoint<S> flank(const S& p, bool on_involute) const {
    if (!law) return involute(p);
    using std::sqrt;
    ProfilePoint<S> q;
    if (on_involute) q = involute(p);
    else
      q = {S(plain_x_C + (p - plain_p_C) * plain_cos_phi),
           S(plain_rho_C + (p - plain_p_C) * plain_sin_phi),
           plain_sin_phi,
           plain_cos_phi,
           S(0),
           S(1)};
    // c(p) along the normal (-sin psi, cos psi), and its derivatives by p, from those by the depth.
    const S dS2 = on_involute ? S(cos_a * kappa_v) : S(0), depth = S(law->tip_mm) - q.x;
    const S x1 = q.dS * q.cos_psi, x2 = dS2 * q.cos_psi - q.dS * q.sin_psi * q.dpsi;
    const S r1 = law->removed.derivative(depth, 1), c = law->removed.derivative(depth, 0), c1 = -r1 * x1,
            c2 = law->removed.derivative(depth, 2) * x1 * x1 - r1 * x2;
    // Its tangent: `along` times the plain one and c1 times the normal.
    const S along = q.dS - c * q.dpsi, along1 = dS2 - c1 * q.dpsi, square = along * along + c1 * c1,
            length = sqrt(square), ct = along / length, st = c1 / length, sp = q.sin_psi, cp = q.cos_psi;
    q.x = q.x - c * sp;
    q.rho = q.rho + c * cp;
    q.sin_psi = sp * ct + cp * st;
    q.cos_psi = cp * ct - sp * st;
    q.dpsi = q.dpsi + (c2 * along - c1 * along1) / square;
    q.dS = length;
    return q;
  }
  /// Point of the straight BC, continued.
  [[nodiscard]] ProfilePoint<S> straight(const S& p) const {
    return {S(x_C + (p - p_C) * cos_phi), S(rho_C + (p - p_C) * sin_phi), sin_phi, cos_phi, S(0), S(1)};
  }
  /// Point of the corner arc, continued, by its inclination.
  [[nodiscard]] ProfilePoint<S> arc(const S& sin_psi, const S& cos_psi) const {
    return {S(x_o - r_t * sin_psi), S(rho_o + r_t * cos_psi), sin_psi, cos_psi, S(S(-1) / r_t), S(1)};
  }
  /// Point of the whole profile A..D, p_A <= p; beyond p_D the flank goes on.
  [[nodiscard]] ProfilePoint<S> at(const S& p) const {
    using std::sin, std::cos;
    if (!(p < p_C)) return flank(p);
    if (!(p < p_B)) return straight(p);
    const S psi = phi + (p_B - p) / r_t;
    return arc(S(sin(psi)), S(cos(psi)));
  }
  /// Radius of the straight BC, continued, at x.
  [[nodiscard]] S line_radius(const S& x) const { return rho_C + (x - x_C) * sin_phi / cos_phi; }
};

/// What defines a profile, by the symbols of docs/bevel_gear.md 4.
template <typename S>
struct FingerMeasures {
  S alpha_n{}, kappa_v{};  ///< kappa_v: 1/r_v of the gear, >= 0
  S h_f{};                 ///< depth of the tip below the pitch cone
  S m_nj{}, r_t{}, h_C{}, x_D{};
};

/// Builds the profile. The numbers may be unusable (pointed tip, arc above C): design checks live in
/// geometry/bevel_gear/limits.h.
/// @param law what modifications take off the flank; null: nothing
template <typename S>
FingerProfile<S> make_finger_profile(const FingerMeasures<S>& measures, std::shared_ptr<const ProfileLaw> law) {
  using std::sin, std::cos, std::atan, std::atan2;
  const auto& [alpha_n, kappa_v, h_f, m_nj, r_t, h_C, x_D] = measures;
  FingerProfile<S> c;
  c.alpha_n = alpha_n;
  c.sin_a = sin(alpha_n);
  c.cos_a = cos(alpha_n);
  c.kappa_v = kappa_v;
  c.r_0 = atan(S(1)) * m_nj;  // pi m / 4
  c.h_f = h_f;
  c.r_t = r_t;
  c.p_C = -h_C / (c.sin_a * c.cos_a);
  if (c.sin_a / c.cos_a + kappa_v * c.p_C < S(0)) {
    c.p_C = -c.sin_a / c.cos_a / kappa_v;
    c.base_circle_clips_C = true;
  }
  ProfilePoint<S> C = c.involute(c.p_C);
  c.phi = alpha_n + kappa_v * (c.r_0 + c.p_C);
  c.plain_p_C = c.p_C, c.plain_x_C = C.x, c.plain_rho_C = C.rho, c.plain_sin_phi = C.sin_psi;
  c.plain_cos_phi = C.cos_psi;
  if (law) {
    c.law = std::move(law);
    const S bent_to = S(c.law->tip_mm) - S(c.law->bent_to);
    if (bent_to < C.x) c.p_C = c.p_C + (bent_to - C.x) / C.cos_psi;
    C = c.flank(c.p_C);
    c.phi = atan2(C.sin_psi, C.cos_psi);
  }
  c.x_C = C.x;
  c.rho_C = C.rho;
  c.sin_phi = C.sin_psi;
  c.cos_phi = C.cos_psi;
  c.x_o = r_t - h_f;
  c.rho_o = c.line_radius(c.x_o) - r_t / c.cos_phi;
  c.x_B = c.x_o - r_t * c.sin_phi;
  c.rho_B = c.rho_o + r_t * c.cos_phi;
  c.p_B = c.p_C - (c.x_C - c.x_B) / c.cos_phi;
  c.p_A = c.p_B - r_t * (S(2) * atan(S(1)) - c.phi);
  // Newton for x(p) = x_D; dx/dp = dS cos(psi) > 0 above the base circle. Converges in 4..6 steps to eps * x_D.
  S p = x_D / (c.sin_a * c.cos_a);
  for (int k = 0; k < 60; ++k) {
    const ProfilePoint<S> q = c.flank(p);
    const S step = (q.x - x_D) / (q.dS * q.cos_psi);
    p -= step;
    if (bevel_detail::magnitude(step) <=
        S(4) * S(std::numeric_limits<S>::epsilon()) * (bevel_detail::magnitude(p) + x_D))
      break;
  }
  c.p_D = p;
  c.x_D = x_D;
  c.rho_D = c.flank(p).rho;
  return c;
}

/// Without modifications.
template <typename S>
FingerProfile<S> make_finger_profile(const S& alpha_n, const S& kappa_v, const S& h_f, const S& m_nj, const S& r_t,
                                     const S& h_C, const S& x_D) {
  return make_finger_profile<S>(FingerMeasures<S>{alpha_n, kappa_v, h_f, m_nj, r_t, h_C, x_D}, nullptr);
}

/// Where the bend of the flank may jump, from p_C to p_D with both.
[[nodiscard]] std::vector<double> flank_joints(const FingerProfile<double>& profile);
/// Places on the flank from p_C to p_D, joints among them, whose chords leave it by at most `chord_mm`.
[[nodiscard]] std::vector<double> flank_steps(const FingerProfile<double>& profile, double chord_mm);

/// Solid cutter: everything inside the profile, the cylinder rho_D going on for ever above D.
class FingerSolid {
 public:
  explicit FingerSolid(const FingerProfile<double>& profile);
  [[nodiscard]] const FingerProfile<double>& profile() const { return c_; }
  /// Distance of the meridian point (x, rho >= 0) to the solid, negative inside; exact to 1e-13 mm near the surface.
  [[nodiscard]] double signed_distance(double x, double rho) const;
  /// Signed distance of a point of the cutter frame.
  [[nodiscard]] double signed_distance(const Vec3& q) const { return signed_distance(q.x(), std::hypot(q.y(), q.z())); }
  /// Radius of the solid at height x, -h_f <= x.
  [[nodiscard]] double radius(double x) const;
  /// Height of the lower surface at radius rho, 0 <= rho <= rho_D.
  [[nodiscard]] double lower_surface(double rho) const;
  [[nodiscard]] double largest_radius() const { return c_.rho_D; }

 private:
  FingerProfile<double> c_;
};

}  // namespace toothpath::bevel_gear
