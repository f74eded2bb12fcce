// The same questions answered by CGAL's AABB_tree, whose only question is the closest point: distances are marched.
#pragma once

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <vector>

#include "cam/tool/body.h"
#include "geometry/mesh/triangle_mesh.h"
#include "tests/support/plain_frustum.h"

namespace toothpath::bench {

class CgalTree {
 public:
  explicit CgalTree(const mesh::TriangleMesh& mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      triangles_.push_back({point(mesh.corner(t, 0)), point(mesh.corner(t, 1)), point(mesh.corner(t, 2))});
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
  }
  [[nodiscard]] Vec3 closest(const Vec3& p) const {
    ++queries;
    const auto q = tree_.closest_point(point(p));
    return {q.x(), q.y(), q.z()};
  }
  [[nodiscard]] double distance(const Vec3& p) const { return (closest(p) - p).norm(); }

  /// Distance of the axis of the cutting part less its radius, up to `within`: steps along the axis as long as the
  /// distance allows.
  [[nodiscard]] double cutting_part(const Vec3& centre, const Vec3& axis, double height, double radius, double within,
                                    double resolution) const {
    double best = within;
    for (double h = 0;;) {
      const double d = distance(centre + h * axis) - radius;
      best = std::min(best, d);
      if (h >= height) return best;
      h = std::min(h + std::max(d - best, 0.0) + resolution, height);
    }
  }

  /// Distance to a solid frustum, up to `within` and to `resolution` from above. Balls about points of the axis clear
  /// slices; what they leave is divided into boxes. Every closest point bounds the distance from above.
  [[nodiscard]] double frustum(const tool::Frustum& f, const Vec3& tip, const Vec3& axis, double within,
                               double resolution) const {
    double best = within;
    slice(f, tip, axis, f.from, f.to, resolution, best);
    return best;
  }
  mutable std::size_t queries = 0;

 private:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>;
  static Kernel::Point_3 point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

  double look(const tool::Frustum& f, const Vec3& tip, const Vec3& axis, const Vec3& x, double& best) const {
    const Vec3 q = closest(x);
    best = std::min(best, test::distance_to_frustum(q, f, tip, axis));
    return (q - x).norm();
  }
  void slice(const tool::Frustum& f, const Vec3& tip, const Vec3& axis, double h0, double h1, double resolution,
             double& best) const {
    const auto radius = [&](double h) {
      return f.radius_from + (f.radius_to - f.radius_from) * (h - f.from) / (f.to - f.from);
    };
    const double r0 = radius(h0), r1 = radius(h1), widest = std::max(r0, r1), middle = 0.5 * (h0 + h1);
    // Centres farther up see a slice over a flat surface as well as ever smaller boxes would.
    for (const double c : {middle, h0 + widest, h0 + 3 * widest}) {
      const double need = std::max(std::hypot(r0, h0 - c), std::hypot(r1, h1 - c));
      const double d = look(f, tip, axis, tip + c * axis, best);
      if (best <= 0 || d - need >= best - resolution) return;
    }
    if (h1 - h0 > widest) {
      slice(f, tip, axis, h0, middle, resolution, best);
      slice(f, tip, axis, middle, h1, resolution, best);
      return;
    }
    const Vec3 e = axis.unitOrthogonal(), g = axis.cross(e);
    box(f, tip, axis, e, g, Vec3(0, 0, middle), Vec3(widest, widest, 0.5 * (h1 - h0)), resolution, best);
  }
  void box(const tool::Frustum& f, const Vec3& tip, const Vec3& axis, const Vec3& e, const Vec3& g, const Vec3& c,
           const Vec3& half, double resolution, double& best) const {
    const Vec3 x = tip + c.x() * e + c.y() * g + c.z() * axis;
    const double reach = half.norm();
    if (best <= 0 || test::distance_to_frustum(x, f, tip, axis) > reach) return;
    if (look(f, tip, axis, x, best) - reach >= best - resolution || reach < 0.25 * resolution) return;
    Eigen::Index k = 0;
    half.maxCoeff(&k);
    Vec3 smaller = half, step = Vec3::Zero();
    smaller[k] *= 0.5;
    step[k] = smaller[k];
    box(f, tip, axis, e, g, c - step, smaller, resolution, best);
    box(f, tip, axis, e, g, c + step, smaller, resolution, best);
  }

  Triangles triangles_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

}  // namespace toothpath::bench
