// A truncated cone and every place within a distance of it: the cutting parts of mills in one convex form.
//
// A ball end with its conical side is a cone whose apex is the centre of the ball, rounded by the ball's radius; a bull
// nose is a cylinder rounded by its corner radius; a flat cutter is a cylinder rounded by nothing. T frame, mm.
#pragma once

#include <algorithm>

#include "cam/tool/frustum_distance.h"

namespace toothpath::tool {

struct RoundedFrustum {
  Frustum core;
  double round = 0;  ///< >= 0
  [[nodiscard]] double widest() const { return std::max(core.radius_from, core.radius_to) + round; }
};

/// Signed distance to the boundary. Exact outside and to the depth `round`; deeper inside it is that of the core, less
/// `round`. Convex in the point.
[[nodiscard]] inline double rounded_distance(const Vec3& point_T, const RoundedFrustum& body) {
  return frustum_distance(point_T, body.core) - body.round;
}

/// The same with a subgradient, no longer than a unit vector.
[[nodiscard]] inline FrustumSlope rounded_slope(const Vec3& point_T, const RoundedFrustum& body) {
  FrustumSlope s = frustum_slope(point_T, body.core);
  s.distance -= body.round;
  return s;
}

/// Lowest z of a rounded frustum whose tool stands with its tip at `tip` and its unit axis `axis`.
[[nodiscard]] inline double lowest_z(const RoundedFrustum& body, const Vec3& tip, const Vec3& axis) {
  return lowest_z(body.core, tip, axis) - body.round;
}

}  // namespace toothpath::tool
