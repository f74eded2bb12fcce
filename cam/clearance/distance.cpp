#include "cam/clearance/distance.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace toothpath::clearance {
namespace {

std::atomic<std::size_t> distances_built{0};

constexpr double kBoundPad = 1e-9;         // mm: rounding of bounds
constexpr std::size_t kPlaceWindow = 16;   // places that share their candidates
constexpr double kPlaceWindowReach = 1.6;  // mm: a longer window looks at too much

/// Crossings of the ray p + t d, t > 0, with the triangles; -1: one of them is too close to an edge to tell.
class RayParity {
 public:
  RayParity(const TreeView& tree, const Vec3& p, const Vec3& d)
      : tree_(tree),
        p_(p),
        d_(d),
        ray_{{p.x(), p.y(), p.z()}, {d.x(), d.y(), d.z()}, {1 / d.x(), 1 / d.y(), 1 / d.z()}} {}
  int count() {
    visit(0);
    return doubtful_ ? -1 : crossings_;
  }

 private:
  void visit(std::int32_t index) {
    if (index < 0) return block(tree_.blocks[~index]);
    const MeshNode& node = tree_.nodes[index];
    for (unsigned lanes = kernels_.ray_to_boxes(node, ray_); lanes != 0 && !doubtful_; lanes &= lanes - 1)
      visit(node.child[std::countr_zero(lanes)]);
  }
  void block(const TriangleBlock& b) {
    const RayLanes lanes = kernels_.ray_to_triangles(b, ray_);
    if (lanes.near_edge != 0) doubtful_ = true;
    for (unsigned left = lanes.through; left != 0; left &= left - 1)
      if (const int lane = std::countr_zero(left); lane == 0 || !repeats(b, lane)) ++crossings_;
    for (unsigned left = lanes.edge_on; left != 0 && !doubtful_; left &= left - 1)  // does the ray come near it at all?
      doubtful_ = near_line(corners_of(b, std::countr_zero(left)));
  }
  /// Empty lanes repeat the first triangle of the block.
  static bool repeats(const TriangleBlock& b, int lane) {
    for (int k = 0; k < 3; ++k)
      if (b.a[k][lane] != b.a[k][0] || b.ab[k][lane] != b.ab[k][0] || b.ac[k][lane] != b.ac[k][0]) return false;
    return true;
  }
  [[nodiscard]] bool near_line(const TriangleCorners& t) const {
    Vec3 foot;
    return segment_to_triangle(p_, d_, 1e6, t, foot) < 1e-12;
  }

  const MeshKernels& kernels_ = mesh_kernels();
  TreeView tree_;
  Vec3 p_, d_;
  RayView ray_;
  int crossings_ = 0;
  bool doubtful_ = false;
};

}  // namespace

TriangleCorners corners_of(const TriangleBlock& b, int lane) {
  const Vec3 a(b.a[0][lane], b.a[1][lane], b.a[2][lane]);
  return {a, a + Vec3(b.ab[0][lane], b.ab[1][lane], b.ab[2][lane]),
          a + Vec3(b.ac[0][lane], b.ac[1][lane], b.ac[2][lane])};
}

Vec3 nearest_on_triangle(const Vec3& p, const TriangleCorners& t) {
  const auto on_edge = [&](const Vec3& a, const Vec3& b) -> Vec3 {
    const Vec3 ab = b - a;
    const double l = ab.squaredNorm();
    return a + (l > 0 ? std::clamp((p - a).dot(ab) / l, 0.0, 1.0) : 0.0) * ab;
  };
  Vec3 best = on_edge(t.a, t.b);
  for (const Vec3& q : {on_edge(t.b, t.c), on_edge(t.c, t.a)})
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  const Vec3 u = t.b - t.a, w = t.c - t.a, n = u.cross(w);
  const double det = n.squaredNorm();
  if (det > 0) {
    const double v = w.cross(n).dot(p - t.a) / det, z = n.cross(u).dot(p - t.a) / det;
    if (v >= 0 && z >= 0 && v + z <= 1) {
      const Vec3 q = t.a + v * u + z * w;
      if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    }
  }
  return best;
}

double segment_to_triangle(const Vec3& a, const Vec3& axis, double height, const TriangleCorners& t, Vec3& foot) {
  double best = INFINITY;
  const auto take = [&](const Vec3& on_segment, const Vec3& on_triangle) {
    const double d = (on_segment - on_triangle).squaredNorm();
    if (d < best) {
      best = d;
      foot = on_triangle;
    }
  };
  // Ends of the segment.
  const Vec3 b = a + height * axis;
  take(a, nearest_on_triangle(a, t));
  take(b, nearest_on_triangle(b, t));
  // The segment against the edges: the nearest points of two segments.
  const auto edge = [&](const Vec3& p, const Vec3& q) {
    const Vec3 e = q - p, r = a - p;
    const double l = e.squaredNorm(), along = axis.dot(e), c = axis.dot(r), f = e.dot(r);
    if (!(l > 0)) return take(a + std::clamp(-c, 0.0, height) * axis, p);
    const double det = l - along * along;
    double h = det > 1e-14 * l ? std::clamp((along * f - c * l) / det, 0.0, height) : 0.0;
    double s = (along * h + f) / l;
    if (s < 0 || s > 1) {
      s = std::clamp(s, 0.0, 1.0);
      h = std::clamp(s * along - c, 0.0, height);
    }
    take(a + h * axis, p + s * e);
  };
  edge(t.a, t.b);
  edge(t.b, t.c);
  edge(t.c, t.a);
  // Through the inside.
  const Vec3 u = t.b - t.a, w = t.c - t.a, q = axis.cross(w);
  const double det = u.dot(q);
  if (std::abs(det) > 1e-14 * u.norm() * w.norm()) {
    const Vec3 s = a - t.a, r = s.cross(u);
    const double v = s.dot(q) / det, z = axis.dot(r) / det, h = w.dot(r) / det;
    if (v >= 0 && z >= 0 && v + z <= 1 && h >= 0 && h <= height) take(a + h * axis, t.a + v * u + z * w);
  }
  return best;
}

void MeshWindow::gather(const TreeView& tree, const CapsuleView& middle, double reach) {
  if (blocks_.size() < 64) blocks_.resize(64);
  std::size_t count = mesh_kernels().gather(tree, middle, reach + kBoundPad, blocks_.data(), blocks_.size());
  if (count > blocks_.size()) {
    blocks_.resize(2 * count);
    count = mesh_kernels().gather(tree, middle, reach + kBoundPad, blocks_.data(), blocks_.size());
  }
  groups_.resize((count + kLanes - 1) / kLanes);
  for (std::size_t k = 0; k < groups_.size() * kLanes; ++k) {
    BoxGroup& g = groups_[k / kLanes];
    const std::size_t lane = k % kLanes;
    const std::int32_t block = k < count ? blocks_[k] : -1;
    const BlockBox empty{{1e100, 1e100, 1e100}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, 0};
    const BlockBox& box = block < 0 ? empty : tree.boxes[block];
    g.block[lane] = block;
    g.radius[lane] = box.radius;
    for (int c = 0; c < 3; ++c) {
      g.centre[c][lane] = box.centre[c];
      g.half[c][lane] = box.half[c];
      for (int d = 0; d < 3; ++d) g.axis[d][c][lane] = box.axis[d][c];
    }
  }
}

MeshDistance::MeshDistance(const mesh::TriangleMesh& mesh) : tree_(mesh) { ++distances_built; }

std::size_t MeshDistance::built() { return distances_built; }

MeshPlace MeshDistance::nearest(const Vec3& p, double within) const {
  MeshPlace place{within, -1, p};
  if (tree_.triangles() == 0) return place;
  const Vec3 local = p - tree_.origin();
  const TriangleHit hit = mesh_kernels().nearest(view(), local.data(), within * within, {});
  if (hit.block < 0) return place;
  const Vec3 foot = nearest_on_triangle(local, corners_of(tree_.blocks()[std::size_t(hit.block)], hit.lane));
  place.distance = std::min((foot - local).norm(), within);
  place.foot = foot + tree_.origin();
  place.triangle = std::ptrdiff_t(tree_.triangle(std::size_t(hit.block), hit.lane));
  return place;
}

void MeshDistance::nearest_along(std::span<const Vec3> path, double within, std::span<double> distances) const {
  if (tree_.triangles() == 0) {
    std::fill(distances.begin(), distances.end(), within);
    return;
  }
  const MeshKernels& kernels = mesh_kernels();
  const TreeView tree = view();
  MeshWindow window;
  TriangleHit near{};
  for (std::size_t from = 0, to = 0; from < path.size(); from = to) {
    to = from + 1;
    while (to < path.size() && to - from < kPlaceWindow && (path[to] - path[from]).norm() < kPlaceWindowReach) ++to;
    const Vec3 middle = 0.5 * (path[from] + path[to - 1]) - tree_.origin();
    double half = 0;
    for (std::size_t k = from; k < to; ++k) half = std::max(half, (path[k] - tree_.origin() - middle).norm());
    // d(k) <= d(middle) + half, so that what is nearest to place k lies within d(middle) + 2 half of the middle.
    near = kernels.nearest(tree, middle.data(), (within + half) * (within + half), near);
    const double reach = std::min(near.block < 0 ? INFINITY : std::sqrt(near.squared) + 2 * half, within + half);
    window.gather(tree, {{middle.x(), middle.y(), middle.z()}, {0, 0, 1}, 0}, reach + 1e-6);
    for (std::size_t k = from; k < to; ++k) {
      const Vec3 p = path[k] - tree_.origin();
      const TriangleHit hit = kernels.nearest_in(tree, window.groups(), window.size(), p.data(), within * within, near);
      if (hit.block < 0) {
        distances[k] = within;
        continue;
      }
      near = hit;
      const Vec3 foot = nearest_on_triangle(p, corners_of(tree_.blocks()[std::size_t(hit.block)], hit.lane));
      distances[k] = std::min((foot - p).norm(), within);
    }
  }
}

MeshPlace MeshDistance::to_segment(const Vec3& centre, const Vec3& axis, double height, double within) const {
  MeshPlace place = nearest(centre, within);
  if (tree_.triangles() == 0) return place;
  const Vec3 local = centre - tree_.origin();
  const CapsuleView segment{{local.x(), local.y(), local.z()}, {axis.x(), axis.y(), axis.z()}, height};
  MeshWindow window;
  double best = place.distance * place.distance;
  window.gather(view(), segment, place.distance);
  for (std::size_t g = 0; g < window.size(); ++g)
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::int32_t block = window.groups()[g].block[lane];
      if (block < 0) continue;
      for (int k = 0; k < kLanes; ++k) {
        Vec3 foot;
        const double d =
            segment_to_triangle(local, axis, height, corners_of(tree_.blocks()[std::size_t(block)], k), foot);
        if (d < best) {
          best = d;
          place = {std::sqrt(d), std::ptrdiff_t(tree_.triangle(std::size_t(block), k)), foot + tree_.origin()};
        }
      }
    }
  return place;
}

bool MeshDistance::inside(const Vec3& p) const {
  if (tree_.triangles() == 0) return false;
  // Directions that no plane of a drawing is likely to hold; the next one where an edge is hit.
  static const Vec3 directions[] = {
      Vec3(0.31415, 0.27182, 0.90954).normalized(), Vec3(-0.57721, 0.41421, 0.70375).normalized(),
      Vec3(0.66274, -0.61803, 0.42264).normalized(), Vec3(0.11803, 0.83462, -0.53791).normalized(),
      Vec3(-0.73205, -0.23606, 0.63907).normalized()};
  for (const Vec3& d : directions) {
    const int crossings = RayParity(view(), p - tree_.origin(), d).count();
    if (crossings >= 0) return crossings % 2 == 1;
  }
  return true;  // on the surface, as far as can be told
}

}  // namespace toothpath::clearance
