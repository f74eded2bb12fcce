// Signed distance from a point to a solid frustum about the z axis of T (tip at the origin), and its slope.
#pragma once

#include "cam/tool_body.h"

namespace toothpath {

/// Signed distance to the boundary, negative inside. The axis is no boundary. Convex in the point where both radii are positive.
[[nodiscard]] double frustum_distance(const Vec3& point_T, const Frustum& body);

/// The same with a subgradient, no longer than a unit vector.
struct FrustumSlope {
  double distance = 0;
  Vec3 gradient = Vec3::Zero();
};
[[nodiscard]] FrustumSlope frustum_slope(const Vec3& point_T, const Frustum& body);

}  // namespace toothpath
