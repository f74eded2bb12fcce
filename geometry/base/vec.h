// Names for the small fixed-size vectors, double or any other scalar, and what they say about the z axis, the axis of
// every gear.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace toothpath {

template <typename S>
using Vec2T = Eigen::Matrix<S, 2, 1>;
template <typename S>
using Vec3T = Eigen::Matrix<S, 3, 1>;
using Vec2 = Vec2T<double>;
using Vec3 = Vec3T<double>;
using Mat3 = Eigen::Matrix3d;

/// Distance from the z axis.
[[nodiscard]] inline double radius(const Vec3& p) { return std::hypot(p.x(), p.y()); }
/// About the z axis from x, in (-pi, pi].
[[nodiscard]] inline double azimuth(const Vec3& p) { return std::atan2(p.y(), p.x()); }
/// Azimuth from one place to another, in (-pi, pi].
[[nodiscard]] inline double angle_from_to(const Vec3& from, const Vec3& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.x() * to.x() + from.y() * to.y());
}
/// A turn about the z axis [rad]: its cosine and sine, for what is turned by it more than once.
template <typename S>
struct TurnT {
  S c{}, s{};
  explicit TurnT(const S& angle) {
    using std::cos, std::sin;
    c = cos(angle);
    s = sin(angle);
  }
  [[nodiscard]] Vec3T<S> operator()(const Vec3T<S>& v) const {
    return {S(c * v[0] - s * v[1]), S(s * v[0] + c * v[1]), v[2]};
  }
  [[nodiscard]] Vec3T<S> back(const Vec3T<S>& v) const {
    return {S(c * v[0] + s * v[1]), S(c * v[1] - s * v[0]), v[2]};
  }
};
using Turn = TurnT<double>;
/// p turned about the z axis by `angle` [rad].
template <typename S>
[[nodiscard]] Vec3T<S> turned(const Vec3T<S>& p, const std::type_identity_t<S>& angle) {
  return TurnT<S>(angle)(p);
}
[[nodiscard]] inline Vec3 turned(const Vec3& p, double angle) { return Turn(angle)(p); }
/// Distance from a point to a segment.
[[nodiscard]] inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double l2 = ab.squaredNorm();
  const double t = l2 > 0 ? std::clamp((p - a).dot(ab) / l2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}
/// Angle between two directions of any length, in [0, pi], with all digits at both ends.
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace toothpath
