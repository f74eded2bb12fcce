// A body as a tree of convex pieces, and the distance between two such bodies.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cam/clearance/distance.h"
#include "geometry/mesh/triangle_mesh.h"
#include "machines/body.h"
#include "postproc/bodies/convex.h"

namespace toothpath::bodies {

/// A ball that, with others, encloses a body: it lies in their convex hull.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

class Solid {
 public:
  /// The union of solid pieces, boxes or cones; one or more.
  explicit Solid(std::vector<Convex> pieces);
  /// A closed mesh with what it encloses; one triangle or more.
  explicit Solid(const mesh::TriangleMesh& mesh);

  /// Balls whose hull holds it.
  [[nodiscard]] const std::vector<Ball>& extent() const { return extent_; }
  /// The axis that all pieces are bodies of revolution about; nothing: there is none.
  [[nodiscard]] const std::optional<std::pair<Vec3, Vec3>>& axis() const { return axis_; }
  /// Farthest point of its convex hull.
  [[nodiscard]] Vec3 farthest(const Vec3& direction) const;

  /// Distance to `other`, which stands at `place` in the frame of this one; mm, up to `within`: of larger
  /// ones `proven` is `within` and `measured` infinite. Touching, overlapping, one inside the other: 0, 0.
  [[nodiscard]] Gap gap_to(const Solid& other, const machines::Place& place, double within) const;

 private:
  struct Node {
    Convex box;
    int left = -1, right = -1;  ///< nodes, or -1 and the piece
    int piece = -1;
  };
  void build(std::vector<int>& pieces);
  int build(std::span<int> pieces);
  [[nodiscard]] const Convex& shape(const Node& node) const {
    return node.piece >= 0 ? pieces_[static_cast<std::size_t>(node.piece)] : node.box;
  }
  [[nodiscard]] bool holds(const Solid& other, const machines::Place& place) const;

  std::vector<Convex> pieces_;
  std::vector<Node> nodes_;  ///< the first is the root
  std::vector<Ball> extent_;
  std::vector<Vec3> anchors_;  ///< a point of every connected part
  std::optional<std::pair<Vec3, Vec3>> axis_;
  std::shared_ptr<const clearance::MeshDistance> mesh_;  ///< of a mesh: what is inside
};

/// A body of a machine file; `mesh` of one that names a file.
[[nodiscard]] Solid solid_of(const machines::MachineBody& body, const mesh::TriangleMesh* mesh);

/// How far two bodies that overlap must be moved apart: the length of the shortest way that was found, and its
/// direction for b, in the frame of a. Of bodies with hollows an upper bound. @param place of b in the frame of a
struct Overlap {
  double depth_mm = 0;
  Vec3 direction = Vec3::UnitZ();
};
[[nodiscard]] Overlap overlap(const Solid& a, const Solid& b, const machines::Place& place);

}  // namespace toothpath::bodies
