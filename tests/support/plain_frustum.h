// The distance to a truncated cone written out side by side, and the gap to a triangle by halving it: second opinions
// for the searches of cam.
#pragma once

#include <algorithm>
#include <cmath>

#include "cam/tool/body.h"

namespace toothpath::test {

/// Distance from a point to a solid frustum with its tip at `tip` and unit axis `axis`; 0 inside.
inline double distance_to_frustum(const Vec3& point, const tool::Frustum& f, const Vec3& tip, const Vec3& axis) {
  const Vec3 d = point - tip;
  const double h = d.dot(axis), rho = (d - h * axis).norm();
  // In the half plane (rho, h): a convex quadrilateral between the axis and the generator.
  const double length = f.to - f.from;
  if (h >= f.from && h <= f.to) {
    const double t = length > 0 ? (h - f.from) / length : 0;
    if (rho <= f.radius_from + t * (f.radius_to - f.radius_from)) return 0;
  }
  const auto to_segment = [&](double r0, double h0, double r1, double h1) {
    const double dr = r1 - r0, dh = h1 - h0, l2 = dr * dr + dh * dh;
    const double t = l2 > 0 ? std::clamp(((rho - r0) * dr + (h - h0) * dh) / l2, 0.0, 1.0) : 0.0;
    return std::hypot(rho - r0 - t * dr, h - h0 - t * dh);
  };
  return std::min({to_segment(0, f.from, f.radius_from, f.from), to_segment(f.radius_from, f.from, f.radius_to, f.to),
                   to_segment(0, f.to, f.radius_to, f.to)});
}

/// Least distance between a triangle and a frustum, from below, or `best` where that is less: the triangle is halved
/// until its size is `resolution` or can matter no more. A triangle that cuts in: -resolution.
inline double triangle_gap(const Vec3& a, const Vec3& b, const Vec3& c, const tool::Frustum& f, const Vec3& tip,
                           const Vec3& axis, double best, double resolution, int depth) {
  if (best <= -resolution) return best;  // inside: how deep does not matter
  const Vec3 centre = (a + b + c) / 3;
  const double size = std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
  const double d = distance_to_frustum(centre, f, tip, axis);
  if (d - size >= best) return best;
  if (d == 0) return std::min(best, -resolution);
  if (size <= resolution || depth == 0) return std::min(best, d - size);
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  best = triangle_gap(ab, bc, ca, f, tip, axis, best, resolution, depth - 1);
  best = triangle_gap(a, ab, ca, f, tip, axis, best, resolution, depth - 1);
  best = triangle_gap(ab, b, bc, f, tip, axis, best, resolution, depth - 1);
  return triangle_gap(ca, bc, c, f, tip, axis, best, resolution, depth - 1);
}

}  // namespace toothpath::test
