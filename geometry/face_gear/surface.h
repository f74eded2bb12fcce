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
  /// Shape operator in an orthonormal tangent basis (e, l), convex positive.
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
  /// The basis (e, l) of a shape operator, in the gear frame.
  struct TangentBasis {
    Vec3T<S> e, l;
  };
  /// dP/dtheta and dP/dB, or dP/dA and dP/dZ, in the gear frame.
  struct Derivatives {
    Vec3T<S> u, v;
  };

  /// A place (theta, B) of the flank of side s; |B| < 80 deg. Sines and cosines are taken once, for all that is asked
  /// of the place; what lies in the gear frame takes the `turn()` that brings it there.
  class FlankPlace {
   public:
    FlankPlace(const FaceGearSurface& f, int s, const S& theta, const S& B) : f_(f), side_(s), theta_(theta), B_(B) {
      using std::cos, std::sin;
      sB_ = sin(B);
      cB_ = cos(B);
      const S r_b = f.shaper.r_b, D = r_b * (S(1) / f.i + f.Cg), w = side_ * r_b * theta;
      Z_ = (D + f.E * f.Cg * sB_ - f.Sg * f.shaper.T * (f.E + r_b * sB_ - w * cB_)) / (f.Sg * cB_);
    }
    /// Z(theta, B) of the equation of meshing on the involute, (3.2).
    [[nodiscard]] const S& Z() const { return Z_; }
    /// dZ/dB at constant theta.
    [[nodiscard]] S Z_B() const { return f_.slope_of_Z(sB_, cB_); }
    /// The point before it is turned into the gear frame: r and z are already right. Housing frame.
    [[nodiscard]] Vec3T<S> housing() const {
      const S w = side_ * theta_;
      const S x = f_.shaper.r_b * (cB_ + w * sB_), y = f_.shaper.r_b * (sB_ - w * cB_);
      return {S(Z_ * f_.Sg - x * f_.Cg), S(f_.E + y), S(-Z_ * f_.Cg - x * f_.Sg)};
    }
    /// Roll angle phi of the shaper at which the place is cut.
    [[nodiscard]] S phi() const { return B_ - side_ * (f_.shaper.theta_0 + theta_) - f_.shaper.kappa * (Z_ - f_.L0); }
    [[nodiscard]] TurnT<S> turn() const { return TurnT<S>(S(-f_.i * phi())); }
    /// Point and normal, (3.3).
    [[nodiscard]] SurfacePointT<S> point(const TurnT<S>& turn) const {
      const Vec3T<S> n = (t() * f_.shaper.cos_bb - f_.a() * f_.shaper.sin_bb) * side_;
      return {turn(housing()), turn(n)};
    }

    /// Terms of the curvatures, and the regularity J (4.1): > 0 on the sheet that is cut, 0 at the undercut edge.
    struct Curvature {
      S M{}, X{}, Y{}, kl{}, J{};
    };
    [[nodiscard]] Curvature curvature() const {
      const S cb = f_.shaper.cos_bb, sb = f_.shaper.sin_bb, r_b = f_.shaper.r_b, E = f_.E, Sg = f_.Sg, Cg = f_.Cg;
      const S w = side_ * r_b * theta_;
      Curvature k;
      k.M = Z_B() * cb + r_b * sb;
      k.X = E * Cg * cB_ + Z_ * Sg * sB_ - w * Cg;
      k.Y = -E * (sB_ * sb * Cg + cb * Sg) + Z_ * sb * Sg * cB_ - r_b * (sb * Cg + cb * Sg * sB_) + w * cb * Sg * cB_;
      k.kl = Sg * sB_ * sb - Cg * cb;
      k.J = k.X * k.M - w * k.Y;
      return k;
    }
    /// Shape operator in the basis of the place, (4.3).
    [[nodiscard]] ShapeOperator shape(const Curvature& k) const {
      ShapeOperator H;
      H.ee = side_ * (f_.shaper.cos_bb * k.Y - k.M * k.kl) / k.J;
      H.el = -side_ * f_.Sg * cB_ * k.M / k.J;
      H.ll = f_.Sg * cB_ * f_.shaper.r_b * theta_ / k.J;
      return H;
    }
    [[nodiscard]] TangentBasis basis(const TurnT<S>& turn) const {
      return {turn(e()), turn(Vec3T<S>(t() * f_.shaper.sin_bb + f_.a() * f_.shaper.cos_bb))};
    }
    /// Derivatives of the place as the gear stands still: those of `housing()` but for its turn with the gear.
    [[nodiscard]] Vec3T<S> housing_theta() const {
      return (t() * f_.shaper.cos_bb - f_.a() * f_.shaper.sin_bb) * S(-side_ * f_.shaper.r_b / f_.shaper.cos_bb);
    }
    [[nodiscard]] Vec3T<S> housing_B() const {
      return f_.a() * Z_B() + t() * f_.shaper.r_b + e() * S(side_ * f_.shaper.r_b * theta_);
    }
    /// dP/dtheta and dP/dB (4.2). @param at  the `point` of the same turn
    [[nodiscard]] Derivatives derivatives(const SurfacePointT<S>& at, const TurnT<S>& turn) const {
      const S cb = f_.shaper.cos_bb;
      const Vec3T<S> kxP(-at.p[1], at.p[0], S(0));
      return {kxP * S(f_.i * side_ / (cb * cb)) - at.n * S(f_.shaper.r_b / cb),
              kxP * S(-f_.i * (S(1) - f_.shaper.kappa * Z_B())) + turn(housing_B())};
    }

   private:
    [[nodiscard]] Vec3T<S> e() const { return {S(-f_.Cg * cB_), sB_, S(-f_.Sg * cB_)}; }
    [[nodiscard]] Vec3T<S> t() const { return {S(f_.Cg * sB_), cB_, S(f_.Sg * sB_)}; }

    const FaceGearSurface& f_;
    S side_, theta_, B_, sB_, cB_, Z_;
  };

  /// What is asked of a place by itself: see `FlankPlace`.
  [[nodiscard]] S flank_Z(int s, const S& theta, const S& B) const { return FlankPlace(*this, s, theta, B).Z(); }
  [[nodiscard]] S flank_Z_B(const S& B) const {
    using std::cos, std::sin;
    return slope_of_Z(sin(B), cos(B));
  }
  [[nodiscard]] Vec3T<S> flank_housing(int s, const S& theta, const S& B) const {
    return FlankPlace(*this, s, theta, B).housing();
  }
  [[nodiscard]] S flank_phi(int s, const S& theta, const S& B) const { return FlankPlace(*this, s, theta, B).phi(); }
  [[nodiscard]] SurfacePointT<S> flank(int s, const S& theta, const S& B) const {
    const FlankPlace at(*this, s, theta, B);
    return at.point(at.turn());
  }
  [[nodiscard]] S flank_J(int s, const S& theta, const S& B) const {
    return FlankPlace(*this, s, theta, B).curvature().J;
  }
  [[nodiscard]] ShapeOperator flank_shape(int s, const S& theta, const S& B) const {
    const FlankPlace at(*this, s, theta, B);
    return at.shape(at.curvature());
  }
  [[nodiscard]] TangentBasis flank_basis(int s, const S& theta, const S& B) const {
    const FlankPlace at(*this, s, theta, B);
    return at.basis(at.turn());
  }
  [[nodiscard]] Derivatives flank_derivatives(int s, const S& theta, const S& B) const {
    const FlankPlace at(*this, s, theta, B);
    const TurnT<S> turn = at.turn();
    return at.derivatives(at.point(turn), turn);
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
  [[nodiscard]] S slope_of_Z(const S& sB, const S& cB) const {
    const S D = shaper.r_b * (S(1) / i + Cg), T = shaper.T;
    return ((D - Sg * T * E) * sB - (Sg * T * shaper.r_b - E * Cg)) / (Sg * cB * cB);
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
  const Vec3T<S> P_f(S(Z * Sg - x * Cg), S(E + y), S(-Z * Cg - x * Sg));
  const S tan_delta = kappa * h, cd = S(1) / sqrt(S(S(1) + tan_delta * tan_delta)), sd = tan_delta * cd;
  const Vec3T<S> t_B(S(Cg * sB), cB, S(Sg * sB));
  const TurnT<S> turn(S(-i * (f.B - side * A - kappa * (Z - L0))));
  f.p = turn(P_f);
  f.n = turn(Vec3T<S>((t_B * cd - a() * sd) * side));
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
