// How far bodies stay above a whole part: its blank lies in h <= top of a chart, and h of a place is convex and changes
// by no more than the place moves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "cam/tool/rounded_frustum.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::proof {

/// Least distance from the z axis of the hull of some places.
[[nodiscard]] inline double least_radius_of_hull(std::span<const Vec3> places) {
  const auto flat = [&](std::size_t k) { return Vec2(places[k].head<2>()); };
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  double least = INFINITY;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i; j < places.size(); ++j) {
      const Vec2 a = flat(i), b = flat(j), way = b - a;
      const double t = way.squaredNorm() > 0 ? std::clamp(-a.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
      least = std::min(least, (a + t * way).norm());
      for (std::size_t k = j + 1; k < places.size(); ++k) {
        const Vec2 c = flat(k);
        const double x = cross(a, b), y = cross(b, c), z = cross(c, a);
        if (x == 0 && y == 0 && z == 0) continue;  // on one line with the axis: its pieces are asked
        if ((x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0)) return 0;
      }
    }
  return least;
}

class Roof {
 public:
  /// The plane z = 0.
  Roof() = default;
  Roof(const tooth_space::Chart& chart, double top_mm) : chart_(chart), top_(top_mm) {}
  explicit Roof(const tooth_space::ToothedPart& part) : chart_(part.chart()), top_(part.blank_top()) {}

  [[nodiscard]] bool flat() const { return chart_.sine == 0; }
  [[nodiscard]] const tooth_space::Chart& chart() const { return chart_; }
  [[nodiscard]] double top() const { return top_; }
  /// Of the hull of some places, from below.
  [[nodiscard]] double over(std::span<const Vec3> places) const {
    double z = INFINITY;
    for (const Vec3& p : places) z = std::min(z, axial(p.z()));
    return flat() ? z - top_ : chart_.sine * least_radius_of_hull(places) + z - top_;
  }
  /// Of a body at every pose between two, whose axis turns straight from one to the other, from below.
  [[nodiscard]] double over(const tool::RoundedFrustum& body, const Vec3& tip_0, const Vec3& axis_0, const Vec3& tip_1,
                            const Vec3& axis_1) const {
    const double z = std::min(axial(body, tip_0, axis_0), axial(body, tip_1, axis_1));
    return flat() ? z - top_ : chart_.sine * least_radius(body, tip_0, axis_0, tip_1, axis_1) + z - top_;
  }
  /// The same at one pose.
  [[nodiscard]] double over(const tool::RoundedFrustum& body, const Vec3& tip, const Vec3& axis) const {
    return over(body, tip, axis, tip, axis);
  }
  [[nodiscard]] double over(const tool::Frustum& body, const Vec3& tip, const Vec3& axis) const {
    return over(tool::RoundedFrustum{body, 0}, tip, axis);
  }

 private:
  [[nodiscard]] double axial(double z) const { return chart_.cosine * z; }
  [[nodiscard]] double axial(const tool::RoundedFrustum& body, const Vec3& tip, const Vec3& axis) const {
    if (chart_.cosine == 0) return 0;
    return chart_.cosine > 0 ? chart_.cosine * tool::lowest_z(body, tip, axis)
                             : -chart_.cosine * tool::lowest_z(body, -tip, -axis);
  }
  static double least_radius(const tool::RoundedFrustum& body, const Vec3& tip_0, const Vec3& axis_0, const Vec3& tip_1,
                             const Vec3& axis_1) {
    const double from = body.core.from, to = body.core.to;
    const std::array<Vec3, 4> ends{tip_0 + from * axis_0, tip_0 + to * axis_0, tip_1 + from * axis_1,
                                   tip_1 + to * axis_1};
    return std::max(0.0, least_radius_of_hull(ends) - body.widest());
  }

  tooth_space::Chart chart_;
  double top_ = 0;
};

}  // namespace toothpath::proof
