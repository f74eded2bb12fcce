// The path of contact of a face gear and an involute pinion in closed form, also misaligned; template on the scalar.
//
// Both flanks have normals of constant moment about their own axis. A line that is normal to the pinion's flank is
// normal to the gear's if it has the gear's moment s M2, its slope against the gear's axis and the height of its foot
// on that axis. The first is linear in the section Z, the second gives B, the third is one equation for the turned
// position B_1 of the normal. Its root does not depend on the pinion's turn: the path of contact is one straight line
// of the housing, and the transmission error is a constant. Derivation: docs/contact.md.
#pragma once

#include <limits>
#include <optional>

#include "geometry/contact/pinion.h"

namespace toothpath::contact {

template <typename S>
struct ContactPath {
  int side = 1;
  bool line_contact =
      false;     ///< pinion and shaper are one: every B_1 is a root, contact is along lines; B = B_1 is one of them
  S B{}, B_1{};  ///< gear: flank parameter of the path; pinion: turned position of its normal
  S Z{};         ///< pinion: section of the normal's base-tangent point
  S shift{};     ///< r_b theta = r_b1 theta_1 + shift
  S turn{};      ///< of the gear between the shaper's place of the normal and the pinion's
  Vec3T<S> start, normal;  ///< housing: base-tangent point on the pinion, common normal out of the gear
  S phi_1_0{}, phi_2_0{};  ///< turns at theta_1 = 0
  S per_theta{};           ///< -d(phi_1)/d(theta_1) = side/cos^2(beta_b)
  S ratio{}, r_b{}, r_b1{}, cos_bb{};

  [[nodiscard]] S theta(const S& theta_1) const { return (r_b1 * theta_1 + shift) / r_b; }
  [[nodiscard]] S phi_1(const S& theta_1) const { return phi_1_0 - per_theta * theta_1; }
  [[nodiscard]] S phi_2(const S& theta_1) const { return phi_2_0 - ratio * per_theta * theta_1; }
  [[nodiscard]] S section(const S& theta_1, const S& T) const { return Z + S(side) * T * r_b1 * theta_1; }
  /// Place of contact in the housing.
  [[nodiscard]] Vec3T<S> point(const S& theta_1) const { return start - normal * S(r_b1 * theta_1 / cos_bb); }
  /// phi_2 - phi_1 N_p/N_2: the transmission error, the same on the whole path. 0 when aligned and without backlash.
  [[nodiscard]] S error() const { return phi_2_0 - phi_1_0 * ratio; }
};

namespace contact_detail {

/// A line by its point nearest to the gear's axis: height there, distance along the line from the given point, azimuth
/// of its direction.
template <typename S>
struct AxisFoot {
  S height{}, along{}, azimuth{};
};
template <typename S>
AxisFoot<S> axis_foot(const Vec3T<S>& point, const Vec3T<S>& n) {
  using std::atan2;
  AxisFoot<S> f;
  f.along = -(point[0] * n[0] + point[1] * n[1]) / (n[0] * n[0] + n[1] * n[1]);
  f.height = point[2] + f.along * n[2];
  f.azimuth = atan2(n[1], n[0]);
  return f;
}

template <typename S>
struct PathTrial {
  bool defined = false;
  S B{}, Z{}, mismatch{};
  Vec3T<S> start, normal;
  AxisFoot<S> pinion, gear;
};

template <typename S>
PathTrial<S> try_normal(const face_gear::FaceGearSurface<S>& gear, const Pinion<S>& pinion, int s, const S& B_1) {
  using std::asin;
  PathTrial<S> trial;
  const S side(s);
  trial.normal = (pinion.t(B_1) * pinion.cos_bb - pinion.a * pinion.sin_bb) * side;
  const Vec3T<S>& n = trial.normal;
  const auto moment = [&](const Vec3T<S>& p) { return S(p[0] * n[1] - p[1] * n[0]); };
  const Vec3T<S> tangent_point = pinion.foot + pinion.e(B_1) * pinion.r_b;
  trial.Z = (side * gear.M2 - moment(tangent_point)) / moment(pinion.a);
  trial.start = tangent_point + pinion.a * trial.Z;
  const S sine = (side * n[2] - gear.Cg * gear.shaper.sin_bb) / (gear.Sg * gear.shaper.cos_bb);
  if (!(sine < S(1)) || !(sine > S(-1))) return trial;
  trial.B = asin(sine);
  const Vec3T<S> n_f = (gear.t(trial.B) * gear.shaper.cos_bb - gear.a() * gear.shaper.sin_bb) * side;
  trial.pinion = axis_foot<S>(trial.start, n);
  trial.gear = axis_foot<S>(gear.flank_housing(s, S(0), trial.B), n_f);
  trial.mismatch = trial.pinion.height - trial.gear.height;
  trial.defined = true;
  return trial;
}

}  // namespace contact_detail

/// The path of flank s. Nothing where no common normal lies within 0.6 rad of the pitch point's: contact is then on
/// edges only. The path may lie outside the flank; whether the flanks reach it is a question of their edges
/// (tooth_contact.h).
template <typename S>
std::optional<ContactPath<S>> contact_path(const face_gear::FaceGearSurface<S>& gear, const Pinion<S>& pinion, int s) {
  using std::abs;
  const S eps = std::numeric_limits<S>::epsilon(), far(0.6), centre = S(s) * gear.shaper.alpha_t;
  const auto trial_at = [&](const S& B_1) { return contact_detail::try_normal(gear, pinion, s, B_1); };
  S x = centre;
  auto at = trial_at(x);
  if (!at.defined) return std::nullopt;
  const S h(1e-3);
  const auto up = trial_at(x + h), down = trial_at(x - h);
  if (!up.defined || !down.defined) return std::nullopt;
  const S slope = (up.mismatch - down.mismatch) / (S(2) * h), small = S(256) * eps * gear.L_p;
  const bool line = abs(up.mismatch) <= small && abs(down.mismatch) <= small && abs(at.mismatch) <= small;
  if (!line && abs(at.mismatch) > small) {
    // Secant: the mismatch is smooth and nearly linear over the flank.
    S before = x, f_before = at.mismatch, step = -at.mismatch / slope;
    for (int k = 0; k < 60; ++k) {
      if (!(abs(step) < far)) step = step > S(0) ? far : S(-far);
      x = before + step;
      if (!(abs(S(x - centre)) <= far)) return std::nullopt;
      at = trial_at(x);
      if (!at.defined) return std::nullopt;
      if (abs(at.mismatch) <= S(16) * eps * gear.L_p || abs(step) <= S(4) * eps) break;
      const S rise = at.mismatch - f_before;
      if (rise == S(0)) break;
      step = -at.mismatch * (x - before) / rise;
      before = x;
      f_before = at.mismatch;
    }
    if (!(abs(at.mismatch) <= S(4096) * eps * gear.L_p)) return std::nullopt;
  }
  ContactPath<S> path;
  path.side = s;
  path.line_contact = line;
  path.B = at.B;
  path.B_1 = x;
  path.Z = at.Z;
  path.start = at.start;
  path.normal = at.normal;
  path.cos_bb = pinion.cos_bb;
  path.r_b = gear.shaper.r_b;
  path.r_b1 = pinion.r_b;
  path.ratio = pinion.ratio;
  path.shift = pinion.cos_bb * (at.pinion.along - at.gear.along);
  path.turn = at.pinion.azimuth - at.gear.azimuth;
  path.per_theta = S(s) / (pinion.cos_bb * pinion.cos_bb);
  path.phi_1_0 = x - S(s) * pinion.theta_0 - pinion.kappa * (at.Z - pinion.L0);
  path.phi_2_0 = path.turn + gear.i * gear.flank_phi(s, path.theta(S(0)), at.B);
  return path;
}

}  // namespace toothpath::contact
