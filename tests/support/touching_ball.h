// Where a ball that moves along a line meets a flank of a gear that stands off its place: three equations in the
// parameters of the flank and the way, by Newton on points of the surface alone; no distance of the program's own.
#pragma once

#include <Eigen/Dense>
#include <optional>

#include "geometry/bevel_gear/gear.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::test {

/// A rigid motion of a gear: turned by `rotation` about its origin, then moved.
struct Stands {
  Mat3 rotation = Mat3::Identity();
  Vec3 moved = Vec3::Zero();
};

/// Centre of the ball when it touches; `above`: ball radius and what stands on the flank. `surface(u, v)` has `.p` and
/// `.n`, in the frame of the gear; u and v: where the search begins.
template <typename Surface>
std::optional<Vec3> ball_on(const Surface& surface, double above, const Stands& stands, const Vec3& from,
                            const Vec3& to, double u, double v) {
  const Vec3 way = (to - from).normalized();
  double t = (to - from).norm() / 2;
  const auto off = [&](double a, double b, double s) -> Vec3 {
    const auto p = surface(a, b);
    const Vec3 centre = stands.rotation * Vec3(p.p + above * p.n) + stands.moved;
    return centre - (from + s * way);
  };
  for (int k = 0; k < 60; ++k) {
    const Vec3 e = off(u, v, t);
    const double h = 1e-6;
    Eigen::Matrix3d J;
    J.col(0) = (off(u + h, v, t) - off(u - h, v, t)) / (2 * h);
    J.col(1) = (off(u, v + h, t) - off(u, v - h, t)) / (2 * h);
    J.col(2) = -way;
    Vec3 x = J.fullPivLu().solve(-e);
    const double angle = std::max(std::abs(x[0]), std::abs(x[1]));
    if (angle > 0.05) x *= 0.05 / angle;
    u += x[0];
    v += x[1];
    t += x[2];
    if (x.norm() < 1e-13) break;
  }
  if (!(off(u, v, t).norm() < 1e-10)) return {};
  return from + t * way;
}

/// The same on a flank of a face gear.
inline std::optional<Vec3> touching_centre(const face_gear::FaceGearSurface<double>& f, int side, int tooth,
                                           double above, const Stands& stands, const Vec3& from, const Vec3& to,
                                           double theta, double B) {
  const auto flank = [&](double th, double b) {
    auto p = f.flank(side, th, b);
    p.p = turned(p.p, tooth * f.pitch);
    p.n = turned(p.n, tooth * f.pitch);
    return p;
  };
  return ball_on(flank, above, stands, from, to, theta, B);
}

/// The same on a wall of a bevel gear, in one of its spaces; the search begins half-way.
inline std::optional<Vec3> touching_centre(const bevel_gear::BevelGear& gear, int half, int sigma, int space,
                                           double above, const Stands& stands, const Vec3& from, const Vec3& to) {
  const auto& wall = gear.halves()[std::size_t(half)].wall(sigma);
  const double turn = space * gear.pitch();
  const auto surface = [&](double beta, double p) {
    auto f = wall.point(beta, p);
    f.p = turned(f.p, turn);
    f.n = turned(f.n, turn);
    return f;
  };
  const auto near = bevel_gear::cone_point(0.5 * (from + to), gear.sin_delta(), gear.cos_delta());
  const auto begin = bevel_inverse(wall, near.ell, near.height);
  if (!begin) return {};
  return ball_on(surface, above, stands, from, to, begin->beta, begin->p);
}

}  // namespace toothpath::test
