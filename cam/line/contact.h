// Line contact of a mill's side with a flank: the leaned axis, and how the distance to the flank bends along it.
//
// A tool of revolution is the union of balls of radius rho(t) about its axis c_0 + t a. It touches a flank along a
// whole line exactly as well as the one function e(t) = d(c_0 + t a) - rho(t) is zero; d is the signed distance to the
// (continued) flank. d is linear along the axis to second order if the axis leans along a direction of zero normal
// curvature of the parallel surface. That surface bends by what the flank's own first derivatives tell (of place and
// normal), so that any gear may be asked. mm, rad. Derivation: docs/line_milling.md, sections 2 and 3.
//
// Kernels are templated on the scalar: double and 50 digits run the same text.
#pragma once

#include <cmath>
#include <optional>

#include "cam/tool/radius_law.h"
#include "geometry/base/vec.h"

namespace toothpath::line {

/// The tangent plane at a flank point: p up along the profile, o along the tooth towards rising s, n out of the
/// material. Orthonormal.
template <typename S>
struct TangentFrame {
  Vec3T<S> p, o, n;
};

/// p is `up`, a unit vector in the meridian plane of the point, without its part along n. No flank is square to it.
template <typename S>
TangentFrame<S> tangent_frame(int side, const Vec3T<S>& n, const Vec3T<S>& up) {
  using std::sqrt;
  const Vec3T<S> across = n.cross(up);
  const S size = sqrt(S(across.dot(across)));
  TangentFrame<S> f;
  f.n = n;
  f.p = Vec3T<S>(across.cross(n) / size);
  f.o = Vec3T<S>(across * S(S(side) / size));
  return f;
}

/// Shape operator of a surface in a tangent frame (p, o), convex positive.
template <typename S>
struct TangentShape {
  S pp{}, po{}, oo{};

  TangentShape() = default;
  /// From the derivatives of place and normal by any two parameters.
  TangentShape(const TangentFrame<S>& f, const Vec3T<S>& pu, const Vec3T<S>& pv, const Vec3T<S>& nu,
               const Vec3T<S>& nv) {
    const S a = pu.dot(f.p), b = pv.dot(f.p), c = pu.dot(f.o), d = pv.dot(f.o), area = a * d - b * c;
    const S up = nu.dot(f.p), vp = nv.dot(f.p), uo = nu.dot(f.o), vo = nv.dot(f.o);
    pp = (up * d - vp * c) / area;
    po = (vp * a - up * b + uo * d - vo * c) / (S(2) * area);
    oo = (vo * a - uo * b) / area;
  }
  [[nodiscard]] S trace() const { return pp + oo; }
  [[nodiscard]] S gauss() const { return pp * oo - po * po; }
  /// By how much areas grow from the surface to its parallel surface at `distance`.
  [[nodiscard]] S growth(const S& distance) const { return S(1) + distance * (trace() + distance * gauss()); }
  /// The parallel surface's H (1 + d H)^-1, times `growth`: H + d K by Cayley and Hamilton. No quotient.
  [[nodiscard]] TangentShape grown(const S& distance) const {
    TangentShape out = *this;
    out.pp += distance * gauss();
    out.oo += distance * gauss();
    return out;
  }
  /// Along a direction (x, y) in (p, o).
  [[nodiscard]] S along(const S& x, const S& y) const { return pp * x * x + S(2) * po * x * y + oo * y * y; }
};

/// Lean psi of the wanted axis for a contact whose axis lies `distance` above a place of the flank with shape H: the
/// direction of zero normal curvature of the parallel surface there, the steeper of the two (nearer to p); where it has
/// none (K >= 0, an involute among them), that of the least. psi > 0 leans towards rising s, on either flank.
/// @param distance  rho of the tool where it touches, and its allowance [mm]; 0: the direction of the flank itself
/// Nothing where a ball of that radius does not fit the hollow of the flank.
/// Error <= 1e-12 rad for a flank that is no nearer to its undercut edge than J = 1e-3 m^2.
template <typename S>
std::optional<S> lean(const TangentShape<S>& H, const S& distance) {
  using std::abs, std::atan2, std::sqrt;
  if (!(H.growth(distance) > S(0)) || !(S(2) + distance * H.trace() > S(0))) return {};
  const TangentShape<S> A = H.grown(distance);
  std::optional<S> best;
  S steepest(-1);
  const auto take = [&](S up, S out) {
    if (up < S(0)) {
      up = -up;
      out = -out;
    }
    const S size = sqrt(S(up * up + out * out));
    if (!(up > steepest * size)) return;
    steepest = up / size;
    best = atan2(out, up);
  };
  if (const S k2 = -A.gauss(); k2 > S(0)) {
    // Both roots of A.along(x, y), written without a quotient, so that neither may be lost.
    const S root = sqrt(k2), q = A.po > S(0) ? S(-(A.po + root)) : S(root - A.po);
    take(A.oo, q);
    take(q, A.pp);
    return best;
  }
  const S half = (A.pp - A.oo) / S(2), root = sqrt(S(half * half + A.po * A.po)), sense(A.trace() < S(0) ? -1 : 1);
  if (!(root > S(0))) return S(0);  // all directions bend alike
  // Least in size is trace / 2 - sense root; its direction by the row that loses no digits.
  const S across = half * sense;
  if (across > S(0)) take(S(-A.po), S(sense * (across + root)));
  else take(S(sense * (across - root)), A.po);
  return best;
}

/// d'' along the unit direction a at a place over a flank point with this frame and shape: a^T (Hess d) a.
template <typename S>
S distance_bend(const TangentFrame<S>& f, const TangentShape<S>& H, const S& distance, const Vec3T<S>& a) {
  return H.grown(distance).along(a.dot(f.p), a.dot(f.o)) / H.growth(distance);
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

}  // namespace toothpath::line
