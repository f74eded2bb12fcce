// Triangles that belong to something, eight at a time: whose triangles lie near a point, and how near. What
// `MeshDistance` is to one mesh, this is to the facets of many cells or edges; a segment is a triangle with two equal
// corners. All in double, in the frame of the facets, mm.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "cam/clearance/tree.h"

namespace toothpath::clearance {

struct Facet {
  std::array<Vec3, 3> corner;
  std::uint32_t owner = 0;
};

class FacetTree {
 public:
  FacetTree() : FacetTree(std::span<const Facet>()) {}
  explicit FacetTree(std::span<const Facet> facets);

  /// visit(owner, distance) for every facet that is nearer than `within` and no more than `slack` farther than the
  /// nearest one, in no stated order. Returns the least distance; infinite where there is none. Error below 1e-8 mm.
  template <typename Visit>
  double near(const Vec3& p, double within, double slack, const Visit& visit) const {
    std::array<BlockHit, 48> few;
    std::vector<BlockHit> many;
    const std::span<const BlockHit> hits = gather(p, within, slack, few, many);
    double least = INFINITY;
    for (const auto& hit : hits)
      for (const double squared : hit.squared) least = std::min(least, squared);
    const double reach = std::min(within, std::sqrt(least) + slack), reach2 = reach * reach;
    for (const auto& hit : hits)
      for (int lane = 0; lane < kLanes; ++lane)
        if (hit.squared[lane] < reach2)
          visit(owner_[tree_.triangle(std::size_t(hit.block), lane)], std::sqrt(hit.squared[lane]));
    return std::sqrt(least);
  }

  /// The least distance, up to `within`.
  [[nodiscard]] double least(const Vec3& p, double within) const;
  /// A lower bound of the least distance from any place of the straight line from `from` along the unit vector `axis`,
  /// up to `within`. Exact for facets whose place nearest to `from` does not lie above it; for the others the distance
  /// across the axis counts.
  [[nodiscard]] double least_along(const Vec3& from, const Vec3& axis, double length, double within) const;

 private:
  [[nodiscard]] std::span<const BlockHit> gather(const Vec3& p, double within, double slack, std::span<BlockHit> few,
                                                 std::vector<BlockHit>& many) const;
  [[nodiscard]] TreeView view() const { return {tree_.nodes().data(), tree_.blocks().data(), tree_.boxes().data()}; }

  std::vector<std::uint32_t> owner_;
  MeshTree tree_;
};

}  // namespace toothpath::clearance
