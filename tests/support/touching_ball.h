// Where a ball that moves along a line meets a flank of a gear that stands off its place: three equations in the
// parameters of the flank and the way, by Newton on points of the surface alone; no distance of the program's own.
#pragma once

#include <Eigen/Dense>
#include <optional>

#include "geometry/face_gear/gear.h"

namespace toothpath::test {

/// A rigid motion of a gear: turned by `rotation` about its origin, then moved.
struct Stands {
  Mat3 rotation = Mat3::Identity();
  Vec3 moved = Vec3::Zero();
};

/// Centre of the ball when it touches; `above`: ball radius and what stands on the flank.
inline std::optional<Vec3> touching_centre(const face_gear::FaceGearSurface<double>& f, int side, int tooth,
                                           double above, const Stands& stands, const Vec3& from, const Vec3& to,
                                           double theta, double B) {
  const Vec3 way = (to - from).normalized();
  double t = (to - from).norm() / 2;
  const auto off = [&](double th, double b, double s) -> Vec3 {
    const auto p = f.flank(side, th, b);
    const Vec3 centre = stands.rotation * turned(p.p + above * p.n, tooth * f.pitch) + stands.moved;
    return centre - (from + s * way);
  };
  for (int k = 0; k < 60; ++k) {
    const Vec3 e = off(theta, B, t);
    const double h = 1e-6;
    Eigen::Matrix3d J;
    J.col(0) = (off(theta + h, B, t) - off(theta - h, B, t)) / (2 * h);
    J.col(1) = (off(theta, B + h, t) - off(theta, B - h, t)) / (2 * h);
    J.col(2) = -way;
    Vec3 x = J.fullPivLu().solve(-e);
    const double angle = std::max(std::abs(x[0]), std::abs(x[1]));
    if (angle > 0.05) x *= 0.05 / angle;
    theta += x[0];
    B += x[1];
    t += x[2];
    if (x.norm() < 1e-13) break;
  }
  if (!(off(theta, B, t).norm() < 1e-10)) return {};
  return from + t * way;
}

}  // namespace toothpath::test
