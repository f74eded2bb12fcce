// Exact distance from points, balls and tool assemblies to any triangle mesh: fixtures, stock, imported parts.
//
// The mesh is taken as it is: what it leaves out of the true surface (its sag) is the caller's. A tree of eight-wide
// boxes finds candidates, double decides. A tool wholly inside the solid has no surface near it: `inside` asks by
// parity.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cam/clearance/tree.h"
#include "cam/tool/assembly.h"
#include "cam/tool/body.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::clearance {

/// Nearest place of a mesh. All lengths mm, in the frame of the mesh.
struct MeshPlace {
  double distance = 0;           ///< >= 0; the limit that was asked for when nothing is nearer
  std::ptrdiff_t triangle = -1;  ///< -1: nothing within the limit
  Vec3 foot = Vec3::Zero();      ///< on the mesh
};

class MeshDistance {
 public:
  /// Any triangles; slivers and repeated corners too. Coordinates up to 1e5 mm.
  explicit MeshDistance(const mesh::TriangleMesh& mesh);

  /// Nearest point of the surface, up to `within`. Error below 1e-9 mm at distances above 1e-3 times the largest
  /// triangle.
  [[nodiscard]] MeshPlace nearest(const Vec3& p, double within) const;

  /// The same for the places of a path, in order: distances up to `within`. Neighbouring places share their candidates.
  void nearest_along(std::span<const Vec3> path, double within, std::span<double> distances) const;

  /// Is p in the solid? Parity of the crossings of a ray; the mesh must be closed. Points on the surface may give
  /// either answer.
  [[nodiscard]] bool inside(const Vec3& p) const;

  /// Distance to a solid frustum, up to `within`: proven from below, at most 1e-9 mm below the true one. 0: touches.
  [[nodiscard]] MeshPlace to_frustum(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double within) const;

  /// A lower bound of the same distance, up to `within`; at most about the size of the triangles nearby below it, and
  /// much faster.
  [[nodiscard]] double frustum_bound(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double within) const;

  /// Distance to the axis of the cutting part, from `centre` over `height` along `axis`, up to `within`.
  [[nodiscard]] MeshPlace to_segment(const Vec3& centre, const Vec3& axis, double height, double within) const;

  [[nodiscard]] const MeshTree& tree() const { return tree_; }
  [[nodiscard]] TreeView view() const { return {tree_.nodes().data(), tree_.blocks().data(), tree_.boxes().data()}; }
  /// How many have been built in this process: shows that a command without meshes needs none.
  static std::size_t built();

 private:
  MeshTree tree_;
};

/// Corners of a lane of the tree, in the tree's frame.
struct TriangleCorners {
  Vec3 a, b, c;
};
[[nodiscard]] TriangleCorners corners_of(const TriangleBlock& block, int lane);

/// Nearest point of a triangle.
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const TriangleCorners& t);

/// Squared distance between the segment a .. a + height * axis (unit) and a triangle; `foot` on the triangle.
[[nodiscard]] double segment_to_triangle(const Vec3& a, const Vec3& axis, double height, const TriangleCorners& t,
                                         Vec3& foot);

/// Candidate blocks about a window of poses, with their own boxes beside each other for the kernels.
class MeshWindow {
 public:
  /// Gathers the blocks within `reach` of the segment from `centre` over `height` along `axis` (tree frame).
  void gather(const TreeView& tree, const CapsuleView& middle, double reach);
  [[nodiscard]] const BoxGroup* groups() const { return groups_.data(); }
  [[nodiscard]] std::size_t size() const { return groups_.size(); }

 private:
  std::vector<std::int32_t> blocks_;
  std::vector<BoxGroup> groups_;
};

}  // namespace toothpath::clearance
