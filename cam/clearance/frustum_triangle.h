// Distance between one solid frustum and one triangle.
#pragma once

#include "cam/clearance/distance.h"

namespace toothpath::clearance {

struct FrustumGap {
  double distance = 0;  ///< proven lower bound, mm
  double above = 0;     ///< a distance that two points of theirs have: the true one lies between `distance` and this
  Vec3 foot = Vec3::Zero();  ///< on the triangle
  int steps = 0;
};

/// Descends until the two bounds meet within 1e-10 mm, or as soon as the distance is proven to be at least `enough`.
/// Where rounding stops the descent first, the bounds say so. Touching or overlapping: 0.
[[nodiscard]] FrustumGap frustum_to_triangle(const tool::Frustum& body, const Vec3& tip, const Vec3& axis,
                                             const TriangleCorners& t, double enough);

[[nodiscard]] FrustumView frustum_view(const tool::Frustum& body, const Vec3& tip, const Vec3& axis);

}  // namespace toothpath::clearance
