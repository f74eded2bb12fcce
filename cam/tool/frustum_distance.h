// Signed distance from a point to a solid frustum about the z axis of T (tip at the origin), and its slope.
#pragma once

#include "cam/tool/body.h"

namespace toothpath::tool {

/// Signed distance to the boundary, negative inside. The axis is no boundary. Convex in the point where both radii are
/// positive.
[[nodiscard]] double frustum_distance(const Vec3& point_T, const Frustum& body);

/// The same with a subgradient, no longer than a unit vector.
struct FrustumSlope {
  double distance = 0;
  Vec3 gradient = Vec3::Zero();
};
[[nodiscard]] FrustumSlope frustum_slope(const Vec3& point_T, const Frustum& body);

/// A frustum that stands somewhere, for many questions: first whether a point is far away, which takes no root.
class PlacedFrustum {
 public:
  /// With the tool's tip at `tip` and its unit axis `axis`, in the frame of the points that are asked.
  PlacedFrustum(const Frustum& body, const Vec3& tip, const Vec3& axis);

  /// Is the point farther than `distance` from the cylinder about the frustum, and so from the frustum? False may mean
  /// either.
  [[nodiscard]] bool beyond(const Vec3& point, double distance) const {
    const Vec3 d = point - tip_;
    const double h = d.dot(axis_), along = h < body_.from ? body_.from - h : h > body_.to ? h - body_.to : 0;
    const double reach = widest_ + distance;
    return along > distance || (d - h * axis_).squaredNorm() > (reach > 0 ? reach * reach : 0);
  }
  /// Signed distance, as `frustum_distance`.
  [[nodiscard]] double distance(const Vec3& point) const;
  /// The same with its slope, as `frustum_slope`, in the frame of the points.
  [[nodiscard]] FrustumSlope slope(const Vec3& point) const;

 private:
  const Frustum& body_;
  Vec3 tip_, axis_;
  double widest_;
};

}  // namespace toothpath::tool
