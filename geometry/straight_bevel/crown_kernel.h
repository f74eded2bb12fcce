// The tooth space of a straight bevel gear, as the crown gear with rounded tooth tips cuts it: flank, fillet and root
// in closed form, for any scalar. All three are cones over a curve on the unit sphere, apex in the pitch apex.
// docs/straight_bevel_gear.md
//
// Crown frame: A along the pitch line, B across it, H out of the pitch cone. Octoid flank: u is the angle a of the
// crown's flank plane, psi plus the turn of the crown. Spherical involute: u is the rolling angle tau from the base
// cone. Fillet: u is the longitude b of the rounding's centre, 0 at the root. Root: the share of its width from the
// plus to the minus edge. v = -R, R the distance from the apex.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/base/vec.h"
#include "geometry/straight_bevel/parameters.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::straight_bevel {

/// @tparam C  scalar of the gear's own numbers: double, or 50 digits
template <typename C>
struct CrownKernel {
  using Piece = tooth_space::Piece;

  int teeth = 0;
  Form form = Form::octoid;
  C sin_d{}, cos_d{};    ///< of the pitch angle
  C sin_a{}, cos_a{};    ///< of the pressure angle
  C R_e{}, R_i{};        ///< outer and inner cone distance
  C theta_f{};           ///< dedendum angle
  C eta{};               ///< half angle of the rounding's cone
  C psi{};               ///< half angle of the crown's tooth in the pitch plane
  C eps{}, chi{};        ///< elevation and longitude of the rounding's centre, crown unturned
  C b_F{};               ///< u of the fillet where it joins the flank
  C u_F{};               ///< u of the flank there
  C cos_db{}, sin_db{};  ///< of the base angle; spherical involute
  C az_0{};              ///< azimuth of that involute's start on the base cone
  C psi_f{};             ///< half angle of the root
  C h_a{}, tip_slope{};  ///< tip surface: h at the large end, and its slope along s

  explicit CrownKernel(const StraightBevelParameters& g) : teeth(g.teeth), form(g.form) {
    using std::acos, std::asin, std::atan, std::atan2, std::cos, std::sin, std::tan;
    const C pi = C(4) * atan(C(1)), d(g.pitch_angle_rad), alpha(g.pressure_angle_rad), m(g.outer_transverse_module_mm);
    sin_d = sin(d);
    cos_d = cos(d);
    sin_a = sin(alpha);
    cos_a = cos(alpha);
    R_e = m * C(teeth) / (C(2) * sin_d);
    R_i = R_e - C(g.face_width_mm);
    theta_f = atan(C(C(g.dedendum_mm) / R_e));
    eta = atan(C(C(g.fillet_radius_mm) / R_e));
    psi = (pi * m / C(2) - C(2) * C(g.thickness_shift) * m + C(g.backlash_mm) / C(2)) / (C(2) * R_e);
    h_a = C(g.addendum_mm);
    tip_slope = g.tip_angle_rad ? C(-tan(C(C(*g.tip_angle_rad) - d))) : C(-h_a / R_e);
    eps = eta - theta_f;
    const C sin_e = sin(eps), cos_e = cos(eps);
    if (form == Form::octoid) {
      chi = psi + asin(C((sin_a * sin_e - sin(eta)) / (cos_a * cos_e)));
      const C kappa = psi - chi;
      b_F = atan2(C(-cos(kappa) * cos_a * sin_e), C(sin_a * cos_e - sin(kappa) * cos_a * sin_e));
      u_F = b_F + kappa;
    } else {
      cos_db = sqrt_of(C(C(1) - sin_d * sin_d * cos_a * cos_a));
      sin_db = sin_d * cos_a;
      const C tau_c = acos(C(sin_e / sin_a)), Delta = atan2(C(sin(tau_c)), C(cos_a * cos(tau_c)));
      chi = Delta - (pi / C(2) - psi - pi / (C(2) * cos_a)) - (tau_c + eta) / cos_a;
      b_F = asin(C(-cos_a * sin_e / (sin_a * cos_e)));
      const Vec3T<C> P = rounding(b_F).contact;
      u_F = tau_of(C(P[0] * cos_d - P[2] * sin_d));
      const C tau_p = tau_of(cos_d);
      az_0 = psi / sin_d - (tau_p / sin_db - atan2(C(sin(tau_p)), C(cos(tau_p) * sin_db)));
    }
    psi_f = chi / sin_d;
  }

  /// The rounding at longitude b of its centre, crown frame: where it touches, and the normal there, out of the gear.
  template <typename S>
  struct Rounding {
    Vec3T<S> contact, normal;
  };
  template <typename S>
  [[nodiscard]] Rounding<S> rounding(const S& b) const {
    using std::cos, std::sin, std::sqrt;
    const S c(C(cos(eps))), s(C(sin(eps))), ce(C(cos(eta))), se(C(sin(eta)));
    const S cb = c * cos(b), sb = c * sin(b), N = sqrt(S(sb * sb + s * s));
    // From the pitch line e away from the centre: (e - centre (centre . e)) / N.
    const Vec3T<S> centre(cb, sb, s), away(N, -cb * sb / N, -cb * s / N);
    return {centre * ce - away * se, centre * se + away * ce};
  }
  /// Rolling angle at which the involute has this cosine of its polar angle; not a number inside the base cone.
  [[nodiscard]] C tau_of(const C& cos_polar) const {
    using std::acos;
    return acos(C(cos_polar / cos_db));
  }

  template <typename S>
  bool place(Piece piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::cos, std::sin, std::sqrt;
    // The half towards growing azimuth, mirrored for the plus side.
    const bool plus = piece == Piece::flank_plus || piece == Piece::fillet_plus;
    Vec3T<S> P, N;
    if (piece == Piece::root) {
      const S at = S(psi_f) * (u + u - S(1.0)), ca = cos(at), sa = sin(at);
      const C tilt_s = sin_d * C(cos(theta_f)) - cos_d * C(sin(theta_f)),
              tilt_c = cos_d * C(cos(theta_f)) + sin_d * C(sin(theta_f));
      P = Vec3T<S>(S(tilt_s) * ca, S(tilt_s) * sa, S(tilt_c));
      N = Vec3T<S>(S(tilt_c) * ca, S(tilt_c) * sa, S(C(-tilt_s)));
    } else if (is_fillet(piece)) {
      const Rounding<S> r = rounding(u);
      turn_back(S(u - S(chi)), r.contact, r.normal, P, N);
    } else if (!is_flank(piece)) {
      return false;
    } else if (form == Form::octoid) {
      const S c = cos(u), s = sin(u), sc = s * S(cos_a), q = sqrt(S(c * c + s * s * S(C(sin_a * sin_a))));
      turn_back(S(u - S(psi)), Vec3T<S>(q, c * sc * S(cos_a) / q, -sc * S(sin_a) / q),
                Vec3T<S>(sc, -c * S(cos_a), S(sin_a)), P, N);
    } else {
      // A great circle rolls on the base cone.
      const S at = u / S(sin_db) + S(az_0), ca = cos(at), sa = sin(at), c = cos(u), s = sin(u);
      const Vec3T<S> base(S(sin_db) * ca, S(sin_db) * sa, S(cos_db)), along(-sa, ca, S(0.0));
      P = base * c - along * s;
      N = Vec3T<S>(-(base * s) - along * c);
    }
    if (plus) {
      P[1] = -P[1];
      N[1] = -N[1];
    }
    p = P * S(-v);
    n = N;
    return true;
  }

  // What KernelSpace asks besides. s = -R along the pitch cone, h out of it.
  template <typename S>
  [[nodiscard]] S tip(const S& s) const {
    return S(h_a) + S(tip_slope) * (s + S(R_e));
  }
  [[nodiscard]] tooth_space::Outline outline() const {
    return tooth_space::outline_on_cone(double(sin_d), double(cos_d), teeth, double(R_i), double(R_e));
  }
  [[nodiscard]] tooth_space::Borders borders(Piece piece) const {
    const tooth_space::WallBorders wall{form == Form::octoid ? -INFINITY : INFINITY, double(u_F), double(b_F), 0};
    return borders_of(piece, wall, wall);
  }
  /// Of any mate: down to the fillet.
  [[nodiscard]] tooth_space::Borders active(Piece flank) const { return borders(flank); }
  [[nodiscard]] Vec2 about_tip(int side, double s) const {
    const double h = tip<double>(s), r = double(cos_d) * h - double(sin_d) * s,
                 z = -double(sin_d) * h - double(cos_d) * s;
    const double u = flank_at(std::atan2(r, z));
    return {u, v_at(tooth_space::flank_of(side), u, s)};
  }
  [[nodiscard]] double v_at(Piece piece, double u, double s) const {
    Vec3 p, n;
    if (!place<double>(piece, u, -1.0, p, n)) return s;
    return s / (double(sin_d) * radius(p) + double(cos_d) * p.z());
  }
  [[nodiscard]] Vec2 longest_step(Piece piece) const { return {piece == Piece::root ? 0.5 : 0.05, 0.05 * double(R_e)}; }

  /// u of the flank at a polar angle; the end of what there is where the flank does not reach it.
  [[nodiscard]] double flank_at(double polar) const {
    const double cosine = std::cos(polar);
    if (form == Form::spherical_involute) return std::acos(std::min(1.0, cosine / double(cos_db)));
    double in = double(u_F), out = -1.5;  // towards the tip a falls
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (in + out);
      (polar_cosine(middle) > cosine ? in : out) = middle;
    }
    return 0.5 * (in + out);
  }
  /// Cosine of the polar angle of the octoid flank.
  [[nodiscard]] double polar_cosine(double a) const {
    const double s = std::sin(a), q = std::sqrt(1 - s * s * double(C(cos_a * cos_a)));
    return q * double(cos_d) + s * double(C(cos_a * sin_a)) / q * double(sin_d);
  }

 private:
  static C sqrt_of(const C& x) {
    using std::sqrt;
    return sqrt(x);
  }
  /// From the crown frame, turned by `turn` about H, to the gear, turned by turn / sin(pitch angle) about z.
  template <typename S>
  void turn_back(const S& turn, const Vec3T<S>& contact, const Vec3T<S>& normal, Vec3T<S>& P, Vec3T<S>& N) const {
    const TurnT<S> back(S(-turn / S(sin_d)));
    const auto in_gear = [&](const Vec3T<S>& x) {
      return back(Vec3T<S>(x[0] * S(sin_d) + x[2] * S(cos_d), x[1], x[0] * S(cos_d) - x[2] * S(sin_d)));
    };
    P = in_gear(contact);
    N = in_gear(normal);
  }
};

}  // namespace toothpath::straight_bevel
