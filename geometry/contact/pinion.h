// The involute pinion that runs with a face gear, placed in the housing, also misaligned.
//
// Same transverse module, pressure angle and hand as the shaper; fewer teeth or as many. Aligned, its axis is parallel
// to the shaper's and lower by the difference of the pitch radii: the pitch cylinders touch from within along the pitch
// line. Side s of the pinion is the flank that runs on side s of the gear. Derivation: docs/contact.md.
#pragma once

#include <cmath>
#include <optional>

#include "geometry/face_gear/surface.h"

namespace toothpath::contact {

/// Where the pinion stands against its nominal place in the housing.
struct Misalignment {
  double offset_mm = 0;  ///< dE, along b
  double axial_mm = 0;   ///< dL, along the pinion's axis, away from the gear's axis
  double angle_rad = 0;  ///< dgamma: error of the shaft angle, about the foot of the common perpendicular of the axes
  double gear_axial_mm = 0;  ///< dG: the gear along its own axis, away from the pinion
  [[nodiscard]] bool none() const { return offset_mm == 0 && axial_mm == 0 && angle_rad == 0 && gear_axial_mm == 0; }
};

template <typename S>
struct Pinion {
  int teeth = 0;
  S r_p{}, r_b{}, r_a{};      ///< pitch, base and tip radius, mm
  S kappa{};                  ///< twist, rad per mm of axis
  S theta_0{};                ///< half tooth-space angle at the base circle (no backlash)
  S theta_a{};                ///< roll parameter at the tip circle
  S cos_bb{}, sin_bb{}, T{};  ///< base helix angle, as the shaper's
  S L0{};                     ///< section in which flank angles are counted
  S ratio{};                  ///< N_p / N_2
  Vec3T<S> a, d, b, foot;     ///< axis, down and across; point of the axis at Z_1 = 0; housing frame

  [[nodiscard]] Vec3T<S> e(const S& x) const {
    using std::cos, std::sin;
    return d * S(cos(x)) + b * S(sin(x));
  }
  [[nodiscard]] Vec3T<S> t(const S& x) const {
    using std::cos, std::sin;
    return b * S(cos(x)) - d * S(sin(x));
  }

  /// Point of flank s of the tooth that meets gear tooth 0, at roll parameter theta and section Z_1, when the pinion
  /// has turned by phi. Housing frame; the normal points out of the gear's material, that is into the pinion.
  [[nodiscard]] face_gear::SurfacePointT<S> flank(int s, const S& theta, const S& Z, const S& phi) const {
    const S B = S(s) * (theta_0 + theta) + kappa * (Z - L0) + phi;
    const Vec3T<S> n = (t(B) * cos_bb - a * sin_bb) * S(s);
    return {Vec3T<S>(foot + a * Z + (e(B) - t(B) * S(S(s) * theta)) * r_b), n};
  }

  /// A housing point in the pinion's cylinder coordinates.
  struct Place {
    S radius{}, Z{};  ///< from the pinion's axis; along it
    S x{}, y{};       ///< along d and b
  };
  [[nodiscard]] Place place(const Vec3T<S>& point) const {
    using std::sqrt;
    const Vec3T<S> v = point - foot;
    Place p;
    p.Z = v.dot(a);
    p.x = v.dot(d);
    p.y = v.dot(b);
    p.radius = sqrt(S(p.x * p.x + p.y * p.y));
    return p;
  }

  /// Turn of the pinion at which flank s passes through the place; radius >= r_b. Closed form: the flank is a helicoid.
  [[nodiscard]] S turn_at(int s, const Place& p) const {
    using std::atan, std::atan2, std::sqrt;
    const S theta = sqrt(S((p.radius - r_b) * (p.radius + r_b))) / r_b;
    return atan2(p.y, p.x) + S(s) * (atan(theta) - theta_0 - theta) - kappa * (p.Z - L0);
  }

  /// Normal distance between a place and flank s when the pinion stands at `phi`: exact, as parallel involute helicoids
  /// are turned copies. Positive: the flank has not reached the place yet.
  [[nodiscard]] S gap(int s, const Place& p, const S& phi) const { return S(s) * r_b * cos_bb * (phi - turn_at(s, p)); }
};

/// @param gear          the flank that the pinion runs on; its shaper gives module, pressure angle, hand, addendum
/// @param pinion_teeth  N_p, 1 <= N_p; more than the shaper's teeth bear on the ends of the face (refused by
/// `check_pinion`)
template <typename S>
Pinion<S> make_pinion(const face_gear::FaceGearSurface<S>& gear, int pinion_teeth, const Misalignment& moved = {}) {
  using std::atan, std::cos, std::sin, std::sqrt, std::tan;
  const face_gear::InvoluteShaper<S>& w = gear.shaper;
  Pinion<S> p;
  p.teeth = pinion_teeth;
  const S share = S(pinion_teeth) / S(w.teeth), pi = S(4) * atan(S(1));
  p.r_p = w.r_p * share;
  p.r_b = w.r_b * share;
  p.r_a = p.r_p + w.h_a;
  p.kappa = w.kappa / share;
  p.theta_0 = pi / S(2 * pinion_teeth) - (tan(w.alpha_t) - w.alpha_t);
  p.theta_a = sqrt(S((p.r_a - p.r_b) * (p.r_a + p.r_b))) / p.r_b;
  p.cos_bb = w.cos_bb;
  p.sin_bb = w.sin_bb;
  p.T = w.T;
  p.L0 = gear.L0;
  p.ratio = gear.i * share;
  const S turn(moved.angle_rad), c = cos(turn), s = sin(turn);
  const S Sg = gear.Sg * c + gear.Cg * s, Cg = gear.Cg * c - gear.Sg * s;
  p.a = Vec3T<S>(Sg, S(0), S(-Cg));
  p.d = Vec3T<S>(S(-Cg), S(0), S(-Sg));
  p.b = gear.b();
  p.foot = gear.b() * S(gear.E + S(moved.offset_mm)) + gear.d() * S(w.r_p - p.r_p) + p.a * S(moved.axial_mm);
  // The axis lies lower than the shaper's, and so does the foot of its perpendicular on the gear's: on the axis this is
  // a place aside from Z_1 = 0 where the shafts are not square.
  p.foot += (gear.a() - p.a) * S(gear.Cg * (w.r_p - p.r_p) / gear.Sg);
  p.foot[2] += S(moved.gear_axial_mm);
  return p;
}

/// Refuses a pinion that cannot run on flanks of this shaper: fewer than 5 teeth, or more teeth than the shaper.
[[nodiscard]] Status check_pinion(const face_gear::FaceGearParameters& gear, int pinion_teeth);

}  // namespace toothpath::contact
