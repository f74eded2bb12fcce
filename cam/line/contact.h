// Line contact of a mill's side with a face gear flank: the leaned axis, the gap along it, and what curvature leaves of
// it.
//
// A tool of revolution is the union of balls of radius rho(t) about its axis c_0 + t a. It touches a flank along a
// whole line exactly as well as the one function e(t) = d(c_0 + t a) - rho(t) is zero; d is the signed distance to the
// (continued) flank, which a face gear has in closed form: parallel surfaces are rotations of the flank. d is linear
// along the axis to second order if the axis leans along a direction of zero normal curvature of the parallel surface.
// Gear frame, mm, rad. Derivation: docs/line_milling.md, sections 2 and 3.
//
// Kernels are templated on the scalar: double, dual numbers and 50 digits run the same text.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "cam/tool/radius_law.h"
#include "geometry/face_gear/flank_foot.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/surface.h"

namespace toothpath::line {

/// Parameters of a place on the flank or on one of its parallel surfaces.
template <typename S>
using Place = face_gear::FlankParameters<S>;
using face_gear::flank_foot, face_gear::FlankFoot, face_gear::theta_at_distance;

/// The tangent plane at a flank point: p up along the profile, o along the tooth outwards, n out of the material.
/// Orthonormal.
template <typename S>
struct TangentFrame {
  Vec3T<S> p, o, n;
};

/// p is z without its part along n; o = s n x z / | | points outwards because (P x n)_z = s M2 on the whole flank, and
/// the same keeps 1 - n_z^2 >= M2^2 / r^2: no flank is level, nothing is singular here.
template <typename S>
TangentFrame<S> tangent_frame(int side, const Vec3T<S>& n) {
  using std::sqrt;
  const S flat = sqrt(S(n[0] * n[0] + n[1] * n[1]));
  TangentFrame<S> f;
  f.n = n;
  f.p = Vec3T<S>(-n[2] * n[0] / flat, -n[2] * n[1] / flat, flat);
  f.o = Vec3T<S>(S(side) * n[1] / flat, S(-side) * n[0] / flat, S(0));
  return f;
}

/// Both directions of zero normal curvature of a saddle, in its tangent basis (e, l), not normalised: the roots of
/// H_ee x^2 + 2 H_el x y + H_ll y^2, written without a quotient, so that neither may be lost. `ok` is false where K >=
/// 0.
template <typename S>
struct ZeroDirections {
  Vec2T<S> first, second;
  bool ok = false;
};
template <typename S>
ZeroDirections<S> zero_directions(const typename face_gear::FaceGearSurface<S>::ShapeOperator& H) {
  using std::sqrt;
  const S k2 = H.el * H.el - H.ee * H.ll;
  if (!(k2 > S(0))) return {};
  const S root = sqrt(k2), q = H.el > S(0) ? S(-(H.el + root)) : S(root - H.el);
  return {Vec2T<S>(H.ll, q), Vec2T<S>(q, H.ee), true};
}

/// Lean psi of the wanted axis at the flank place (theta, B) for a contact whose axis lies `distance` above the flank:
/// the direction of zero normal curvature of the parallel surface there, the steeper of the two (nearer to p). psi > 0
/// leans outwards, on either flank.
/// @param distance  rho of the tool where it touches [mm]; 0: the zero direction of the flank itself
/// Nothing where J <= 0 at the flank or on the parallel surface: beyond the undercut edge.
/// Error <= 1e-12 rad for J > 1e-3 m^2.
template <typename S>
std::optional<S> lean(const face_gear::FaceGearSurface<S>& f, int side, const Place<S>& at, const S& distance) {
  using std::atan2, std::sqrt;
  const S theta = theta_at_distance(f, at.theta, distance);
  const typename face_gear::FaceGearSurface<S>::FlankPlace parallel(f, side, theta, at.B), on(f, side, at.theta, at.B);
  const auto bend = parallel.curvature();
  if (!(bend.J > S(0)) || !(on.curvature().J > S(0))) return {};
  const auto roots = zero_directions<S>(parallel.shape(bend));
  if (!roots.ok) return {};
  const auto turn = on.turn();
  const auto basis = on.basis(turn);
  const auto frame = tangent_frame<S>(side, on.point(turn).n);
  std::optional<S> best;
  S steepest(-1);
  for (const auto& root : {roots.first, roots.second}) {
    Vec3T<S> u = basis.e * root[0] + basis.l * root[1];
    u = Vec3T<S>(u / S(sqrt(S(u.dot(u)))));
    S up = u.dot(frame.p), out = u.dot(frame.o);
    if (up < S(0)) {
      up = -up;
      out = -out;
    }
    if (!(up > steepest)) continue;
    steepest = up;
    best = atan2(out, up);
  }
  return best;
}

/// A straight tool axis: the ball of radius rho(t) is centred on c_0 + t a; c_0 is the centre of the ball end. mm, a
/// unit, tip to holder.
template <typename S>
struct AxisLine {
  Vec3T<S> c_0, a;
  [[nodiscard]] Vec3T<S> at(const S& t) const { return c_0 + a * t; }
};

/// What a pose is made of, seen from its anchor P on the flank.
template <typename S>
struct PoseAngles {
  S psi{};     ///< lean within the tangent plane, rad
  S eps{0};    ///< turn of the axis away from the flank, beyond the angle of the side, rad
  S delta{0};  ///< gap at the anchor, mm
  S t_m{};     ///< height of the contact with the anchor above the centre of the ball end, mm
};

/// a = cos(sigma) u + sin(sigma) n with u = cos(psi) p + sin(psi) o and sigma = asin(rho'(t_m)) + eps.
template <typename S>
Vec3T<S> axis_direction(const TangentFrame<S>& f, const S& psi, const S& sigma) {
  using std::cos, std::sin;
  const S c = cos(sigma);
  return f.p * S(c * cos(psi)) + f.o * S(c * sin(psi)) + f.n * S(sin(sigma));
}

/// The axis of a pose: c_0 = P + n (rho(t_m) + delta) - t_m a.
template <typename S>
AxisLine<S> axis_of(const Vec3T<S>& P, const TangentFrame<S>& frame, const tool::RadiusLaw<S>& law,
                    const PoseAngles<S>& pose) {
  using std::asin;
  const Vec3T<S> a = axis_direction<S>(frame, pose.psi, S(asin(law.slope(pose.t_m)) + pose.eps));
  return {Vec3T<S>(P + frame.n * S(law.rho(pose.t_m) + pose.delta) - a * pose.t_m), a};
}

/// d'' along the unit direction a at a place with this foot: a^T (Hess d) a, the shape operator of the parallel
/// surface.
template <typename S>
S distance_bend(const face_gear::FaceGearSurface<S>& f, int side, const FlankFoot<S>& foot, const Vec3T<S>& a) {
  const typename face_gear::FaceGearSurface<S>::FlankPlace at(f, side, foot.at.theta, foot.at.B);
  const auto H = at.shape(at.curvature());
  const auto basis = at.basis(at.turn());
  const TurnT<S> turn(foot.turn);
  const S e = a.dot(turn(basis.e)), l = a.dot(turn(basis.l));
  return H.ee * e * e + S(2) * H.el * e * l + H.ll * l * l;
}

/// d''' along the axis at height t, from dual numbers through `flank_foot` and `distance_bend`. 1/mm^2.
/// @param start  parameters near the foot of that place
[[nodiscard]] std::optional<double> distance_third(const face_gear::FaceGearSurface<double>& f, int side,
                                                   const AxisLine<double>& axis, double t, const Place<double>& start);

/// What the best pose leaves of a gap with this third derivative over a line of half length h along the axis: |D3| h^3
/// / 12, the Chebyshev polynomial T_3 stood on zero. mm
[[nodiscard]] inline double left_estimate(double third, double half_length) {
  return std::abs(third) * half_length * half_length * half_length / 12;
}

}  // namespace toothpath::line
