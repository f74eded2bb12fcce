// The nearest place of a flank to a point of space, in closed form but for two unknowns: parallel surfaces of a face
// gear flank are the flank turned about the gear axis, so that the parallel surface through the point is found by its
// radius and height alone, and the distance is the turn. docs/face_gear.md 5, docs/line_milling.md 2. Gear frame, mm,
// rad.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Parameters of a place on the flank or on one of its parallel surfaces.
template <typename S>
struct FlankParameters {
  S theta{}, B{};
};

/// theta of the parallel surface at `distance` above the flank place (theta, B); B stays.
template <typename S>
S theta_at_distance(const FaceGearSurface<S>& f, const S& theta, const S& distance) {
  return theta - distance * f.shaper.cos_bb / f.shaper.r_b;
}

/// A point of space against the continued flank of side s of tooth 0.
template <typename S>
struct FlankFoot {
  FlankParameters<S> at;  ///< of the parallel surface through the point; the foot has the same B
  S turn{};               ///< by which the flank is turned about z onto that parallel surface
  S d{};                  ///< signed distance, positive outside the material: s M2 turn
  S theta_foot{};         ///< roll parameter of the foot
  Vec3T<S> n;             ///< grad d: the normal at the foot
};

/// Newton for (theta, B) at the point's (r, z) from `start`, which must be near (a neighbour on the same axis); no
/// continuation, no other sheet: nothing is returned where it does not arrive within `kSteps` or arrives at J <= 0.
/// Error of d <= 1e-13 r. Converges quadratically; stops after a step below 1e-3 sqrt(eps) in both parameters, at least
/// one step is taken (so that dual numbers carry their derivatives).
template <typename S>
std::optional<FlankFoot<S>> flank_foot(const FaceGearSurface<S>& f, int side, const Vec3T<S>& x,
                                       const FlankParameters<S>& start) {
  using std::atan2, std::sqrt;
  using FlankPlace = typename FaceGearSurface<S>::FlankPlace;
  constexpr int kSteps = 30;
  const auto size = [](const S& v) { return v < S(0) ? S(-v) : v; };
  const S r = sqrt(S(x[0] * x[0] + x[1] * x[1])), small = S(1e-3) * S(sqrt(S(std::numeric_limits<double>::epsilon())));
  S enough = small;
  if constexpr (std::numeric_limits<S>::digits > 60) enough = S(1e-3) * S(sqrt(S(std::numeric_limits<S>::epsilon())));
  FlankFoot<S> out;
  out.at = start;
  bool arrived = false;
  for (int k = 0; k < kSteps && !arrived; ++k) {
    const FlankPlace now(f, side, out.at.theta, out.at.B);
    const Vec3T<S> P = now.housing(), P_theta = now.housing_theta(), P_B = now.housing_B();
    const S r_now = sqrt(S(P[0] * P[0] + P[1] * P[1])), er = r - r_now, ez = x[2] - P[2];
    const S rt = (P[0] * P_theta[0] + P[1] * P_theta[1]) / r_now, rB = (P[0] * P_B[0] + P[1] * P_B[1]) / r_now;
    const S det = rt * P_B[2] - rB * P_theta[2];
    S dt = (er * P_B[2] - rB * ez) / det, dB = (rt * ez - er * P_theta[2]) / det;
    const S step = std::max(size(dt), size(dB));
    if (!(step < S(10))) return {};
    if (step > S(0.1)) {
      dt = dt * (S(0.1) / step);
      dB = dB * (S(0.1) / step);
    }
    out.at.theta += dt;
    out.at.B += dB;
    arrived = step < enough;
  }
  if (!arrived) return {};
  const FlankPlace place(f, side, out.at.theta, out.at.B);
  if (!(place.curvature().J > S(0))) return {};
  const auto on = place.point(place.turn());
  out.turn = atan2(S(on.p[0] * x[1] - on.p[1] * x[0]), S(on.p[0] * x[0] + on.p[1] * x[1]));
  out.d = S(side) * f.M2 * out.turn;
  out.theta_foot = out.at.theta + out.d * f.shaper.cos_bb / f.shaper.r_b;
  out.n = turned(on.n, out.turn);
  return out;
}

}  // namespace toothpath::face_gear
