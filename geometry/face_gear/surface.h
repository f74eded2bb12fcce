// The surfaces of one face gear tooth in closed form: flank, fillet, root land, tip surface.
//
// Gear frame: z is the gear axis, teeth point to +z, origin at the foot of the common perpendicular of gear and
// shaper axis. Housing frame = gear frame at phi = 0 with a (shaper axis, away from the gear axis), d (from the
// shaper axis towards the gear), b = (0, 1, 0). Side s = +1: the flank of tooth 0 whose outward normal has a
// positive azimuthal component. Normals point out of the gear material. mm and rad.
//
// The flank is parametrised by (theta, B): roll parameter and angle of the base-tangent point in the housing; the
// equation of meshing is linear in Z there, so nothing is iterated and nothing divides by the helix or the offset.
// The fillet and the root land, where cos B -> 0, are parametrised by (A, Z). Derivation: docs/face_gear.md.
#pragma once

#include <cmath>

#include "geometry/base/vec.h"
#include "geometry/face_gear/shaper.h"

namespace toothpath::face_gear {

/// A surface point with its unit normal out of the material, both 3 x 1 in the gear frame.
template <typename S>
struct SurfacePointT {
  Vec3T<S> p = Vec3T<S>::Zero(), n = Vec3T<S>::Zero();
};

/// One ring of teeth of a face gear, endless in radius: the kernels of its surfaces.
template <typename S>
struct FaceGearSurface {
  InvoluteShaper<S> shaper;
  S i{};         ///< N_s / N_2
  S E{};         ///< offset
  S Sg{}, Cg{};  ///< sine and cosine of the shaft angle
  S L0{};        ///< reference section of the helix
  S L_p{};       ///< pitch point on the shaper axis
  S M2{};        ///< |(P x n)_z| of the whole flank: r_b cos(beta_b) N_2 / N_s
  S pitch{};     ///< angular pitch 2 pi / N_2

  [[nodiscard]] Vec3T<S> a() const { return {Sg, S(0), S(-Cg)}; }
  [[nodiscard]] Vec3T<S> d() const { return {S(-Cg), S(0), S(-Sg)}; }
  [[nodiscard]] Vec3T<S> b() const { return {S(0), S(1), S(0)}; }
  /// e(x) = cos x d + sin x b and t(x) = -sin x d + cos x b.
  [[nodiscard]] Vec3T<S> e(const S& x) const {
    using std::cos, std::sin;
    const S c = cos(x);
    return {S(-Cg * c), sin(x), S(-Sg * c)};
  }
  [[nodiscard]] Vec3T<S> t(const S& x) const {
    using std::cos, std::sin;
    const S s = sin(x);
    return {S(Cg * s), cos(x), S(Sg * s)};
  }
  /// v turned about z by `angle`.
  static Vec3T<S> turned(const Vec3T<S>& v, const S& angle) {
    using std::cos, std::sin;
    const S c = cos(angle), s = sin(angle);
    return {S(c * v[0] - s * v[1]), S(s * v[0] + c * v[1]), v[2]};
  }

  /// Z(theta, B) of the equation of meshing on the involute, (3.2). |B| < 80 deg.
  [[nodiscard]] S flank_Z(int s, const S& theta, const S& B) const {
    using std::cos, std::sin;
    const S sb = sin(B), cb = cos(B), r_b = shaper.r_b;
    const S D = r_b * (S(1) / i + Cg);
    const S w = S(s) * r_b * theta;
    return (D + E * Cg * sb - Sg * shaper.T * (E + r_b * sb - w * cb)) / (Sg * cb);
  }

  /// dZ/dB at constant theta.
  [[nodiscard]] S flank_Z_B(const S& B) const {
    using std::cos, std::sin;
    const S D = shaper.r_b * (S(1) / i + Cg), T = shaper.T;
    return ((D - Sg * T * E) * sin(B) - (Sg * T * shaper.r_b - E * Cg)) / (Sg * cos(B) * cos(B));
  }

  /// Flank point before it is turned into the gear frame: r and z are already right. Housing frame.
  [[nodiscard]] Vec3T<S> flank_housing(int s, const S& theta, const S& B) const {
    using std::cos, std::sin;
    const S sb = sin(B), cb = cos(B), w = S(s) * theta, Z = flank_Z(s, theta, B);
    const S x = shaper.r_b * (cb + w * sb), y = shaper.r_b * (sb - w * cb);
    return {S(Z * Sg - x * Cg), S(E + y), S(-Z * Cg - x * Sg)};
  }

  /// Roll angle phi of the shaper at which (theta, B) is cut.
  [[nodiscard]] S flank_phi(int s, const S& theta, const S& B) const {
    return B - S(s) * (shaper.theta_0 + theta) - shaper.kappa * (flank_Z(s, theta, B) - L0);
  }

  /// Flank point and normal, (3.3).
  [[nodiscard]] SurfacePointT<S> flank(int s, const S& theta, const S& B) const {
    const S turn = -i * flank_phi(s, theta, B);
    const Vec3T<S> n = (t(B) * shaper.cos_bb - a() * shaper.sin_bb) * S(s);
    return {turned(flank_housing(s, theta, B), turn), turned(n, turn)};
  }

  /// Regularity (4.1): > 0 on the sheet that is cut, 0 at the undercut edge.
  [[nodiscard]] S flank_J(int s, const S& theta, const S& B) const {
    const auto k = curvature_terms(s, theta, B);
    return k.J;
  }

  /// Shape operator in the orthonormal tangent basis (e, l), convex positive, (4.3).
  struct ShapeOperator {
    S ee{}, el{}, ll{};
    /// Larger (more convex) and smaller (more concave) principal curvature, 1/mm.
    [[nodiscard]] S k1() const {
      using std::sqrt;
      return S((ee + ll) / S(2)) + radius();
    }
    [[nodiscard]] S k2() const { return S((ee + ll) / S(2)) - radius(); }
    [[nodiscard]] S gauss() const { return ee * ll - el * el; }

   private:
    [[nodiscard]] S radius() const {
      using std::sqrt;
      const S h = (ee - ll) / S(2);
      return sqrt(S(h * h + el * el));
    }
  };
  [[nodiscard]] ShapeOperator flank_shape(int s, const S& theta, const S& B) const {
    using std::cos, std::sin;
    const auto k = curvature_terms(s, theta, B);
    ShapeOperator H;
    H.ee = S(s) * (shaper.cos_bb * k.Y - k.M * k.kl) / k.J;
    H.el = -S(s) * Sg * cos(B) * k.M / k.J;
    H.ll = Sg * cos(B) * shaper.r_b * theta / k.J;
    return H;
  }
  /// The basis (e, l) of `flank_shape`, in the gear frame.
  struct TangentBasis {
    Vec3T<S> e, l;
  };
  [[nodiscard]] TangentBasis flank_basis(int s, const S& theta, const S& B) const {
    const S turn = -i * flank_phi(s, theta, B);
    return {turned(e(B), turn), turned(Vec3T<S>(t(B) * shaper.sin_bb + a() * shaper.cos_bb), turn)};
  }
  /// dP/dtheta and dP/dB in the gear frame (4.2).
  struct Derivatives {
    Vec3T<S> u, v;
  };
  [[nodiscard]] Derivatives flank_derivatives(int s, const S& theta, const S& B) const {
    const auto pt = flank(s, theta, B);
    const S turn = -i * flank_phi(s, theta, B), cb = shaper.cos_bb, ZB = flank_Z_B(B);
    const Vec3T<S> kxP(-pt.p[1], pt.p[0], S(0));
    const Vec3T<S> in_housing = a() * ZB + t(B) * shaper.r_b + e(B) * S(S(s) * shaper.r_b * theta);
    return {kxP * S(i * S(s) / (cb * cb)) - pt.n * S(shaper.r_b / cb),
            kxP * S(-i * (S(1) - shaper.kappa * ZB)) + turned(in_housing, turn)};
  }

  /// Fillet point and normal at normal angle A in [A_t, A_e], section Z on the shaper axis, (5.1).
  /// `defined` is false (and the point meaningless) where |D_h| > hypot(S, C): no contact there.
  struct FilletPoint {
    Vec3T<S> p, n;
    S B{};
    bool defined = true;
  };
  [[nodiscard]] FilletPoint fillet(int s, const S& A, const S& Z) const {
    return swept_profile(s, A, Z, shaper.rounding_h(A), shaper.rounding_g(A));
  }
  /// The flank in the same (A, Z) form: h = r_b, g = r_b theta. Well conditioned for |B| > 5 deg.
  [[nodiscard]] FilletPoint flank_by_A(int s, const S& theta, const S& Z) const {
    return swept_profile(s, S(shaper.theta_0 + theta), Z, shaper.r_b, S(shaper.r_b * theta));
  }

  /// Shape operator of the fillet in (e, l), l = t sin(delta) + a cos(delta); convex positive. rho > 0.
  [[nodiscard]] ShapeOperator fillet_shape(int s, const S& A, const S& Z) const;
  [[nodiscard]] TangentBasis fillet_basis(int s, const S& A, const S& Z) const;

  /// Root surface of revolution (plane z = -r_a for a shaft angle of 90 deg): the point of the shaper's tip cylinder at
  /// section Z that touches it, in the housing frame; turn it about z for any other azimuth. Normal out of the
  /// material.
  [[nodiscard]] SurfacePointT<S> root_meridian(const S& Z) const;

  /// Azimuth at which the root land of the tooth space 0 | 1 begins (side +1) or ends (side -1), at section Z.
  /// Unwrapped: continuous in Z, not reduced to one turn.
  [[nodiscard]] S root_edge_azimuth(int side, const S& Z) const;

  /// Height of the tip surface at radius r; r > |E|.
  [[nodiscard]] S z_tip(const S& r) const {
    using std::sqrt;
    const S x = shaper.r_p - shaper.h_a;
    const S Z = (sqrt(S(r * r - E * E)) + x * Cg) / Sg;
    return -Z * Cg - x * Sg;
  }

 private:
  struct CurvatureTerms {
    S M{}, X{}, Y{}, kl{}, J{};
  };
  [[nodiscard]] CurvatureTerms curvature_terms(int s, const S& theta, const S& B) const {
    using std::cos, std::sin;
    const S cb = shaper.cos_bb, sb = shaper.sin_bb, r_b = shaper.r_b, cB = cos(B), sB = sin(B);
    const S Z = flank_Z(s, theta, B), ZB = flank_Z_B(B), w = S(s) * r_b * theta;
    CurvatureTerms k;
    k.M = ZB * cb + r_b * sb;
    k.X = E * Cg * cB + Z * Sg * sB - w * Cg;
    k.Y = -E * (sB * sb * Cg + cb * Sg) + Z * sb * Sg * cB - r_b * (sb * Cg + cb * Sg * sB) + w * cb * Sg * cB;
    k.kl = Sg * sB * sb - Cg * cb;
    k.J = k.X * k.M - w * k.Y;
    return k;
  }
  [[nodiscard]] FilletPoint swept_profile(int s, const S& A, const S& Z, const S& h, const S& g) const;
};

/// Kernels of one zone. The parameters must have passed `FaceGear::make` or be known to be sound.
template <typename S>
FaceGearSurface<S> make_surface(const FaceGearParameters& gear, double helix_angle_rad) {
  using std::atan, std::cos, std::sin;
  FaceGearSurface<S> f;
  f.shaper = make_shaper<S>(gear, helix_angle_rad);
  const S pi = S(4) * atan(S(1)), N_2(gear.teeth), N_s(gear.shaper_teeth);
  f.i = N_s / N_2;
  f.E = S(gear.offset_mm);
  const bool right_angle = std::abs(gear.shaft_angle_rad - 1.5707963267948966) < 1e-15;
  f.Sg = right_angle ? S(1) : S(sin(S(gear.shaft_angle_rad)));
  f.Cg = right_angle ? S(0) : S(cos(S(gear.shaft_angle_rad)));
  f.L_p = f.shaper.r_p * (S(1) / f.i + f.Cg) / f.Sg;
  f.L0 = gear.reference_radius_mm ? S(*gear.reference_radius_mm) : f.L_p;
  f.M2 = f.shaper.r_b * f.shaper.cos_bb * N_2 / N_s;
  f.pitch = S(2) * pi / N_2;
  return f;
}

template <typename S>
typename FaceGearSurface<S>::FilletPoint FaceGearSurface<S>::swept_profile(int s, const S& A, const S& Z, const S& h,
                                                                           const S& g) const {
  using std::acos, std::atan, std::atan2, std::cos, std::sin, std::sqrt;
  const S kappa = shaper.kappa, side(s);
  const S C = Sg * (Z - side * kappa * g * h);
  const S Sn = h * h * kappa * Sg - E * Cg;
  const S D_h = h * (S(1) / i + Cg) - h * kappa * E * Sg;
  const S amplitude = sqrt(S(Sn * Sn + C * C));
  FilletPoint f;
  const S ratio = D_h / amplitude;
  if (!(ratio <= S(1)) || !(ratio >= S(-1))) {
    f.defined = false;
    return f;
  }
  f.B = atan2(Sn, C) + side * acos(ratio);
  const S sB = sin(f.B), cB = cos(f.B);
  const S x = h * cB + side * g * sB, y = h * sB - side * g * cB;
  const S turn = -i * (f.B - side * A - kappa * (Z - L0));
  const Vec3T<S> P_f(S(Z * Sg - x * Cg), S(E + y), S(-Z * Cg - x * Sg));
  const S tan_delta = kappa * h, cd = S(1) / sqrt(S(S(1) + tan_delta * tan_delta)), sd = tan_delta * cd;
  f.p = turned(P_f, turn);
  f.n = turned(Vec3T<S>((t(f.B) * cd - a() * sd) * side), turn);
  return f;
}

template <typename S>
typename FaceGearSurface<S>::TangentBasis FaceGearSurface<S>::fillet_basis(int s, const S& A, const S& Z) const {
  using std::sqrt;
  const auto f = fillet(s, A, Z);
  const S h = shaper.rounding_h(A), tan_delta = shaper.kappa * h;
  const S cd = S(1) / sqrt(S(S(1) + tan_delta * tan_delta)), sd = tan_delta * cd;
  const S turn = -i * (f.B - S(s) * A - shaper.kappa * (Z - L0));
  return {turned(e(f.B), turn), turned(Vec3T<S>(t(f.B) * sd + a() * cd), turn)};
}

template <typename S>
typename FaceGearSurface<S>::ShapeOperator FaceGearSurface<S>::fillet_shape(int s, const S& A, const S& Z) const {
  using std::sqrt;
  const S kappa = shaper.kappa, side(s), h = shaper.rounding_h(A), g = shaper.rounding_g(A);
  const S k_t = S(1) / shaper.rho;
  const auto f = fillet(s, A, Z);
  const S tan_delta = kappa * h, cd = S(1) / sqrt(S(S(1) + tan_delta * tan_delta)), sd = tan_delta * cd;
  // Everything in the housing frame.
  using std::cos, std::sin;
  const S sB = sin(f.B), cB = cos(f.B);
  const S x = h * cB + side * g * sB, y = h * sB - side * g * cB;
  const Vec3T<S> P(S(Z * Sg - x * Cg), S(E + y), S(-Z * Cg - x * Sg)), axis = a(), k(S(0), S(0), S(1)), Eb = b() * E;
  const Vec3T<S> n_s = -(t(f.B) * cd - axis * sd) * side;
  const Vec3T<S> e_ = e(f.B), l_ = t(f.B) * sd + axis * cd, r_v = P - Eb;
  const Vec3T<S> W = -(axis.cross(r_v) - k.cross(P) * i), Om = axis - k * i;
  const Vec3T<S> W1 = k.cross(axis).cross(r_v) * i - axis.cross(k.cross(Eb)) * i;
  const S delta1 = side * kappa * cd * cd * (S(1) - g * k_t);
  const S a11 = k_t * cd, a12 = delta1, a22 = -side * kappa * g * cd * delta1;
  const S we = W.dot(e_), wl = W.dot(l_);
  const Vec3T<S> on = Om.cross(n_s);
  const S q1 = a11 * we + a12 * wl + on.dot(e_), q2 = a12 * we + a22 * wl + on.dot(l_);
  const S c = q1 * we + q2 * wl + n_s.dot(W1);
  ShapeOperator H;
  H.ee = q1 * q1 / c - a11;
  H.el = q1 * q2 / c - a12;
  H.ll = q2 * q2 / c - a22;
  return H;
}

template <typename S>
SurfacePointT<S> FaceGearSurface<S>::root_meridian(const S& Z) const {
  using std::sqrt;
  // The foot of the gear's material on the tip cylinder of the shaper at section Z; the normal of the cylinder there.
  const S tan_w = -E * Cg / (Z * Sg), cw = S(1) / sqrt(S(S(1) + tan_w * tan_w)), sw = tan_w * cw;
  const S x = shaper.r_a * cw, y = shaper.r_a * sw;
  const Vec3T<S> P(S(Z * Sg - x * Cg), S(E + y), S(-Z * Cg - x * Sg));
  const Vec3T<S> n = -(d() * cw + b() * sw);
  return {P, n};
}

template <typename S>
S FaceGearSurface<S>::root_edge_azimuth(int side, const S& Z) const {
  using std::atan2;
  const auto f = fillet(side, shaper.A_e, Z);
  const S turn = -i * (f.B - S(side) * shaper.A_e - shaper.kappa * (Z - L0));
  const Vec3T<S> in_housing = turned(f.p, S(-turn));
  const S azimuth = atan2(in_housing[1], in_housing[0]) + turn;
  return side > 0 ? azimuth : S(azimuth + pitch);
}

}  // namespace toothpath::face_gear
