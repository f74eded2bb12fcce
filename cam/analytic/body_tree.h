// Spheres about spheres over the surfaces of one tooth: how far a shank or holder keeps from all teeth, asked many
// thousand times while a tool direction is searched.
//
// The facets of the gear's cells in a binary tree of bounding spheres; a branch is left as soon as its sphere lies
// farther from the body than the least gap so far, a facet as soon as the tangent plane of the distance at its middle
// does. All teeth are turned copies of one tree, and only those within reach of the body are asked. Answers do not
// depend on the order of the search.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/proof/roof.h"
#include "cam/tool/body.h"

namespace toothpath::analytic {

class BodyTree {
 public:
  explicit BodyTree(const GearDistance& part);

  /// Least gap between a frustum and the finished teeth, from below: no more than `resolution_mm` and the sag of the
  /// cells under the true one; gaps above `enough` are returned as `enough`. A body that cuts in: -resolution_mm.
  [[nodiscard]] double gap(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double enough,
                           double resolution_mm) const;

  /// Is that gap at least `clearance_mm`? Ends at the first facet that stands in the way.
  [[nodiscard]] bool keeps(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double clearance_mm,
                           double resolution_mm) const;
  /// The same for the teeth of all other zones: the rings across the relief groove.
  [[nodiscard]] bool keeps_other_rings(int zone, const tool::Frustum& body, const Vec3& tip, const Vec3& axis,
                                       double clearance_mm, double resolution_mm) const;
  /// The same for every body.
  [[nodiscard]] bool clear(const std::vector<tool::Frustum>& bodies, const Vec3& tip, const Vec3& axis,
                           double clearance_mm, double resolution_mm) const;

  /// By how much a body would have to be slimmer, and begin higher, to cut nowhere with the tool's tip at any of
  /// `tips`, to `resolution_mm`; `deepest_mm` where that is not enough.
  [[nodiscard]] double depth(const tool::Frustum& body, std::span<const Vec3> tips, const Vec3& axis, double deepest_mm,
                             double resolution_mm) const;

 private:
  struct Node {
    Vec3 centre = Vec3::Zero();
    double radius = 0;
    std::uint32_t first = 0, count = 0;  ///< cells of a leaf
    std::uint32_t left = 0, right = 0;   ///< children, when count is 0
  };
  struct Cell {
    Vec3 centre = Vec3::Zero();
    double radius = 0;  ///< of a sphere that holds its facets
    std::uint32_t first = 0, count = 0;
  };
  struct Facet {
    std::array<Vec3, 3> corner;
    Vec3 centre = Vec3::Zero();
    double size = 0;  ///< of the sphere about the centre
  };
  struct Zone {
    std::vector<Node> nodes;
    std::vector<Cell> cells;  ///< leaf by leaf
    std::vector<Facet> facets;
  };
  class Search;
  static std::uint32_t build(Zone& zone, std::uint32_t first, std::uint32_t count);
  [[nodiscard]] double least(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double enough, double stop,
                             double resolution_mm, int left_out = -1) const;

  proof::Roof roof_;
  double sag_, pitch_;
  std::vector<Zone> zones_;
  std::vector<std::pair<double, double>> turns_;  ///< cosine and sine of every tooth's index angle
};

}  // namespace toothpath::analytic
