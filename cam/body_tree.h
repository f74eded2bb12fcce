// Spheres about spheres over the surfaces of one tooth: how far a shank or holder keeps from all teeth, asked many thousand
// times while a tool direction is searched.
//
// The same cells as `body_gap`, in a binary tree of bounding spheres; a branch is left as soon as its sphere lies farther from the
// body than the least gap so far. All teeth are turned copies of one tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cam/gear_distance.h"
#include "cam/tool_body.h"

namespace toothpath {

class BodyTree {
 public:
  explicit BodyTree(const GearDistance& part);

  /// Least gap between a frustum and the finished teeth, from below: no more than `resolution_mm` and the sag of the cells under the
  /// true one; gaps above `enough` are returned as `enough`. A body that cuts in has a gap of -resolution_mm or less.
  [[nodiscard]] BodyGap gap(const Frustum& body, const Vec3& tip, const Vec3& axis, double enough, double resolution_mm) const;

  /// Does every body keep `clearance_mm` (with `resolution_mm` to spare at most)?
  [[nodiscard]] bool clear(const std::vector<Frustum>& bodies, const Vec3& tip, const Vec3& axis, double clearance_mm,
                           double resolution_mm) const;

  /// By how much a body would have to be slimmer, and begin higher, to cut nowhere with the tool's tip at any of `tips`, to `resolution_mm`;
  /// `deepest_mm` where that is not enough.
  [[nodiscard]] double depth(const Frustum& body, std::span<const Vec3> tips, const Vec3& axis, double deepest_mm, double resolution_mm) const;

 private:
  struct Node {
    Vec3 centre = Vec3::Zero();
    double radius = 0;
    std::uint32_t first = 0, count = 0;  ///< cells of a leaf
    std::uint32_t left = 0, right = 0;   ///< children, when count is 0
  };
  struct Zone {
    std::vector<Node> nodes;
    std::vector<std::uint32_t> order;  ///< cells, leaf by leaf
  };
  std::uint32_t build(Zone& zone, const std::vector<GearDistance::Cell>& cells, std::uint32_t first, std::uint32_t count) const;

  const GearDistance& part_;
  std::vector<Zone> zones_;
  std::vector<std::pair<double, double>> turns_;  ///< cosine and sine of every tooth's index angle
};

}  // namespace toothpath
