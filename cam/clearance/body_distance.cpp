// Distance between a solid frustum and the triangles of a mesh. Both are convex, so that the distance of their
// difference set from the origin is found by descending on simplices (Gilbert, Johnson, Keerthi 1988); support planes
// prove it from below.
#include <algorithm>
#include <array>
#include <cmath>

#include "cam/clearance/distance.h"
#include "cam/clearance/frustum_triangle.h"

namespace toothpath::clearance {
namespace {

class FrustumSearch {
 public:
  FrustumSearch(const MeshTree& tree, const TreeView& view, const tool::Frustum& body, const Vec3& tip,
                const Vec3& axis, double within)
      : tree_(tree),
        view_(view),
        body_(body),
        tip_(tip),
        axis_(axis),
        f_(frustum_view(body, tip, axis)),
        best_{within, -1, tip} {}

  MeshPlace run() {
    node(0);
    return best_;
  }

 private:
  void node(std::int32_t index) {
    const MeshNode& n = view_.nodes[index];
    alignas(64) double d[kLanes];
    mesh_kernels().frustum_to_boxes(n, f_, d);
    std::array<int, kLanes> order{};
    int count = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(d[lane] - kRounding < best_.distance)) continue;
      int k = count++;
      while (k > 0 && d[order[std::size_t(k - 1)]] > d[lane]) {
        order[std::size_t(k)] = order[std::size_t(k - 1)];
        --k;
      }
      order[std::size_t(k)] = lane;
    }
    for (int k = 0; k < count; ++k) {
      const int lane = order[std::size_t(k)];
      if (!(d[lane] - kRounding < best_.distance)) return;
      if (n.child[lane] >= 0) node(n.child[lane]);
      else block(~n.child[lane]);
      if (best_.distance <= 0) return;
    }
  }
  void block(std::int32_t index) {
    const TriangleBlock& b = view_.blocks[index];
    alignas(64) double d[kLanes];
    mesh_kernels().frustum_to_triangles(b, f_, d);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(d[lane] - kRounding < best_.distance)) continue;
      const FrustumGap gap = frustum_to_triangle(body_, tip_, axis_, corners_of(b, lane), best_.distance);
      if (gap.distance < best_.distance)
        best_ = {gap.distance, std::ptrdiff_t(tree_.triangle(std::size_t(index), lane)), gap.foot + tree_.origin()};
    }
  }

  static constexpr double kRounding = 1e-9;
  const MeshTree& tree_;
  TreeView view_;
  const tool::Frustum& body_;
  Vec3 tip_, axis_;
  FrustumView f_;
  MeshPlace best_;
};

/// The least of the kernels' lower bounds.
void least_bound(const TreeView& view, const FrustumView& f, std::int32_t index, double& best) {
  const MeshNode& n = view.nodes[index];
  alignas(64) double d[kLanes], t[kLanes];
  mesh_kernels().frustum_to_boxes(n, f, d);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(d[lane] < best)) continue;
    if (n.child[lane] >= 0) {
      least_bound(view, f, n.child[lane], best);
    } else {
      mesh_kernels().frustum_to_triangles(view.blocks[~n.child[lane]], f, t);
      for (int k = 0; k < kLanes; ++k) best = std::min(best, t[k]);
    }
  }
}

}  // namespace

double MeshDistance::frustum_bound(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double within) const {
  constexpr double rounding = 1e-9;
  double best = within + rounding;
  if (tree_.triangles() > 0) least_bound(view(), frustum_view(body, tip - tree_.origin(), axis), 0, best);
  return std::max(best - rounding, 0.0);
}

FrustumView frustum_view(const tool::Frustum& body, const Vec3& tip, const Vec3& axis) {
  const double length = body.to - body.from, slope = length > 0 ? (body.radius_to - body.radius_from) / length : 0;
  FrustumView f{{tip.x(), tip.y(), tip.z()},
                {axis.x(), axis.y(), axis.z()},
                body.from,
                body.to,
                body.radius_from,
                body.radius_to,
                std::max(body.radius_from, body.radius_to),
                slope,
                1 / std::sqrt(1 + slope * slope)};
  if (!(length > 0)) f.cosine = 0;  // a disc: the cone says nothing
  return f;
}

MeshPlace MeshDistance::to_frustum(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double within) const {
  if (tree_.triangles() == 0 || !(within > 0)) return {within, -1, tip};
  return FrustumSearch(tree_, view(), body, tip - tree_.origin(), axis, within).run();
}

}  // namespace toothpath::clearance
