// The tooth space of a cylindrical involute gear, as a basic rack with rounded tips cuts it: flank, trochoid fillet and
// root cylinder in closed form, for any scalar. docs/cylindrical_gear.md
//
// All three are a curve in the transverse plane z = 0 that turns by kappa z on its way along the axis. Flank: u is the
// roll angle theta, r = r_b sqrt(1 + theta^2). Fillet: u is the angle w of the rack's rounding, from the pressure angle
// at the flank to 90 deg at the root. Root: u is the share of its width from the plus to the minus edge. v is z.
#pragma once

#include <cmath>

#include "geometry/base/vec.h"
#include "geometry/cylindrical/parameters.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::cylindrical {

/// @tparam C  scalar of the gear's own numbers: double, or 50 digits
template <typename C>
struct InvoluteKernel {
  using Piece = tooth_space::Piece;

  int teeth = 0;
  C m{};                       ///< as given
  C m_t{}, m_n{};              ///< transverse and normal module
  C alpha_t{}, alpha_n{};      ///< pressure angles
  C r{}, r_b{}, r_f{}, r_a{};  ///< reference, base, root and tip radius
  C cos_b{}, sin_b{};          ///< of the helix angle, sin signed
  C kappa{};                   ///< tan(beta)/r: twist per mm
  C cos_bb{}, sin_bb{};        ///< of the base helix angle
  C rho{};                     ///< rounding of the rack
  C w_t{};                     ///< half width of the rack's tip if it were sharp, normal plane
  C v_c{};                     ///< centre of the rounding, from the middle of the rack's tooth
  C eta_b{};                   ///< half angle of the space on the base cylinder, the involute continued
  C quarter{};                 ///< 90 deg
  C theta_f{};                 ///< roll angle where the rack's flank ends: < 0 is undercut
  C theta_a{};                 ///< roll angle at the tip
  C psi_f{};                   ///< half angle of the root
  double z_from = 0, z_to = 0;

  InvoluteKernel(const CylindricalParameters& gear, const CylindricalZone& zone)
      : teeth(gear.teeth), m(gear.module_mm), z_from(zone.from_mm), z_to(zone.to_mm) {
    using std::atan, std::cos, std::sin, std::sqrt, std::tan;
    const C beta(zone.helix_angle_rad), alpha(gear.pressure_angle_rad), z(teeth), x(gear.profile_shift),
        pi = C(4) * atan(C(1)), h_f = C(gear.dedendum_coefficient) * m, A_s(gear.thickness_allowance_mm);
    quarter = pi / C(2);
    cos_b = cos(beta);
    sin_b = sin(beta);
    if (gear.module_plane == ModulePlane::normal) {
      m_n = m;
      m_t = m / cos_b;
      alpha_n = alpha;
      alpha_t = atan(C(tan(alpha) / cos_b));
    } else {
      m_t = m;
      m_n = m * cos_b;
      alpha_t = alpha;
      alpha_n = atan(C(tan(alpha) * cos_b));
    }
    r = m_t * z / C(2);
    r_b = r * cos(alpha_t);
    r_f = r + m * x - h_f;
    r_a = gear.tip_diameter_mm ? C(*gear.tip_diameter_mm) / C(2) : r + m * (x + C(gear.addendum_coefficient));
    kappa = sin_b / (cos_b * r);
    const C T = kappa * r_b;
    cos_bb = C(1) / sqrt(C(C(1) + T * T));
    sin_bb = T * cos_bb;
    rho = C(gear.root_radius_coefficient) * m;
    const C slope = tan(alpha_n);
    w_t = pi * m_n / C(4) - A_s / C(2) - h_f * slope;
    v_c = w_t - rho * (C(1) - sin(alpha_n)) / cos(alpha_n);
    eta_b = pi / (C(2) * z) - (C(2) * x * m * slope + A_s) / (m_n * z) - (tan(alpha_t) - alpha_t);
    const C h_F = r - r_f - rho * (C(1) - sin(alpha_n));
    theta_f = (r * sin(alpha_t) - h_F / sin(alpha_t)) / r_b;
    theta_a = sqrt(C(r_a * r_a / (r_b * r_b) - C(1)));
    psi_f = v_c / (r * cos_b);
  }

  /// Half angle of the space at roll angle theta, transverse.
  [[nodiscard]] C eta(const C& theta) const {
    using std::atan;
    return eta_b + theta - atan(theta);
  }
  [[nodiscard]] C theta_at(const C& radius) const {
    using std::sqrt;
    return sqrt(C(radius * radius / (r_b * r_b) - C(1)));
  }

  template <typename S>
  bool place(Piece piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::cos, std::sin, std::tan;
    // The half towards growing azimuth, mirrored for the plus side; and how far it stands turned at this height.
    const bool plus = piece == Piece::flank_plus || piece == Piece::fillet_plus;
    const S side(plus ? -1.0 : 1.0);
    S turn = S(kappa) * v;
    if (is_flank(piece)) {
      const S a = S(eta_b) + u, c = cos(a), s = sin(a);
      p = Vec3T<S>(S(r_b) * (c + u * s), side * S(r_b) * (s - u * c), v);
      n = Vec3T<S>(S(cos_bb) * s, -side * S(cos_bb) * c, side * S(sin_bb));
    } else if (is_fillet(piece)) {
      // The rack's place touches where its normal meets the pitch line; the gear has rolled by t then. Written without
      // differences of what grows together, so that boxes stay tight.
      const S c = cos(u), s = sin(u), lever = S(cos_b * (r - r_f - rho)) * tan(S(S(quarter) - u)),
              x = S(r_f + rho) - S(rho) * s, y = lever + S(cos_b * rho) * c,
              t = (lever - S(v_c / cos_b) - S(rho * sin_b * sin_b / cos_b) * c) / S(r);
      p = Vec3T<S>(x, side * y, v);
      n = Vec3T<S>(s, -side * S(cos_b) * c, side * S(sin_b) * c);
      turn -= side * t;
    } else if (piece == Piece::root) {
      p = Vec3T<S>(S(r_f), S(0.0), v);
      n = Vec3T<S>(S(1.0), S(0.0), S(0.0));
      turn += S(psi_f) * (u + u - S(1.0));
    } else {
      return false;
    }
    const TurnT<S> placed(turn);
    p = placed(p);
    n = placed(n);
    return true;
  }

  // What KernelSpace asks besides. s = -z, h = r.
  template <typename S>
  [[nodiscard]] S tip(const S&) const {
    return S(r_a);
  }
  [[nodiscard]] tooth_space::Outline outline() const {
    tooth_space::Outline out;
    out.chart = {0, 1};
    out.pitch = kTwoPi / teeth;
    out.s_from = -z_to;
    out.s_to = -z_from;
    out.from = "upper";
    out.to = "lower";
    out.along = "z";
    out.sign = -1;
    return out;
  }
  [[nodiscard]] tooth_space::Borders borders(Piece piece) const {
    constexpr double kQuarter = 1.5707963267948966192313216916398;
    const tooth_space::WallBorders wall{INFINITY, double(theta_f), double(alpha_n), kQuarter};
    return borders_of(piece, wall, wall);
  }
  /// Of any mate: down to the fillet.
  [[nodiscard]] tooth_space::Borders active(Piece flank) const { return borders(flank); }
  [[nodiscard]] Vec2 about_tip(int, double s) const { return {double(theta_a), -s}; }
  [[nodiscard]] double v_at(Piece, double, double s) const { return -s; }
  [[nodiscard]] Vec2 longest_step(Piece piece) const { return {piece == Piece::root ? 0.5 : 0.15, 2 * double(m)}; }
};

}  // namespace toothpath::cylindrical
