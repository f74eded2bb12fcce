// Directions seen from a pole: polar angles, and the great circle between two of them.
#pragma once

#include "geometry/base/vec.h"

namespace toothpath::numbers {

/// Nearer to the pole than this [rad] a direction has no azimuth.
inline constexpr double kNoAzimuth = 1e-13;

/// Angle between two unit vectors, 0..pi, with all digits at both ends.
[[nodiscard]] double angle_between_axes(const Vec3& a, const Vec3& b);
/// The direction at the share t of the great circle from a to b, less than half a turn apart.
[[nodiscard]] Vec3 blend_axes(const Vec3& a, const Vec3& b, double t);

/// Polar angles about one pole [rad].
struct PoleFrame {
  Vec3 pole, e1, e2;
  explicit PoleFrame(const Vec3& p) : pole(p), e1(p.unitOrthogonal()), e2(p.cross(e1)) {}
  [[nodiscard]] double theta(const Vec3& u) const { return angle_between_axes(u, pole); }
  [[nodiscard]] double phi(const Vec3& u) const;
  [[nodiscard]] Vec3 axis(double theta, double phi) const;
};

/// A great circle from u to v seen from the pole.
struct PoleArc {
  double least = 0, at = 0;      ///< least angle to the pole, and where on the arc (0..1)
  double turn = 0, azimuth = 0;  ///< of the tool; of the azimuth, signed, 0 where an end has none
};
[[nodiscard]] PoleArc pole_arc(const PoleFrame& frame, const Vec3& u, const Vec3& v);

}  // namespace toothpath::numbers
