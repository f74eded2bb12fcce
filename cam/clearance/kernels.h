// The inner loops of the mesh distance, four doubles at a time. One source, compiled twice: for any x86-64 (or other)
// processor, and with AVX2; `mesh_kernels()` picks one when the program starts. Both give the same bits: no fused
// multiply-add, no reordering. This header includes no Eigen: inline functions compiled for AVX2 must not spread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace toothpath::clearance {

inline constexpr int kLanes = 8;

/// Boxes of eight children, mm, in the frame of the tree. Empty lanes stand at 1e150.
struct alignas(64) MeshNode {
  double low[3][kLanes], high[3][kLanes];
  std::int32_t child[kLanes];  ///< >= 0: a node; < 0: block ~child
};

/// Eight triangles. Corner a, edges ab and ac, and what the point distance needs of them; degenerate triangles have
/// zeros for the inverses, so that their edges decide. Empty lanes repeat the first triangle.
struct alignas(64) TriangleBlock {
  double a[3][kLanes], ab[3][kLanes], ac[3][kLanes];
  double g11[kLanes], g12[kLanes], g22[kLanes];                       ///< ab.ab, ab.ac, ac.ac
  double inverse_ab[kLanes], inverse_ac[kLanes], inverse_bc[kLanes];  ///< 1 / squared length, 0 for a point
  double inverse_det[kLanes];  ///< 1 / (g11 g22 - g12^2), 0 where it is not safely positive
};

/// The box of a block along its own directions: flat where the triangles are.
struct BlockBox {
  double centre[3], axis[3][3], half[3];
  double radius;  ///< of the sphere about `centre` that holds the block
};

/// What a kernel sees of a tree. Points are in the tree's frame.
struct TreeView {
  const MeshNode* nodes = nullptr;
  const TriangleBlock* blocks = nullptr;
  const BlockBox* boxes = nullptr;
};

/// A triangle of the tree with its squared distance.
struct TriangleHit {
  double squared = 0;
  std::int32_t block = -1;  ///< -1: none within the limit
  std::int32_t lane = 0;
};

/// A block of which some triangle lies near, with the squared distances of all its lanes.
struct alignas(64) BlockHit {
  double squared[kLanes];
  std::int32_t block = 0;
};

/// A window of candidate blocks about some neighbouring poses: their own boxes, eight at a time.
struct alignas(64) BoxGroup {
  double centre[3][kLanes], axis[3][3][kLanes], half[3][kLanes];
  double radius[kLanes];
  std::int32_t block[kLanes];  ///< -1: empty (its centre stands far away)
};

/// A truncated cone about an axis in the tree's frame, with what the bounds need.
struct FrustumView {
  double tip[3], axis[3];
  double from, to;  ///< heights
  double radius_from, radius_to, widest;
  double slope, cosine;  ///< of the generator: dr/dh and 1/sqrt(1 + slope^2)
};

/// The cutting part: a ball at `centre` and the flute above it.
struct CapsuleView {
  double centre[3], axis[3];
  double height;  ///< of the flute above the centre
};

/// A ray from p along d.
struct RayView {
  double p[3], d[3], inverse[3];  ///< 1 / d
};

/// How a ray goes by the triangles of a block: a bit a lane.
struct RayLanes {
  unsigned through = 0;
  unsigned near_edge = 0;  ///< too close to an edge, or to its own start, to tell
  unsigned edge_on = 0;    ///< in the plane of the triangle, or the triangle has none
};

struct MeshKernels {
  const char* name;
  /// Nearest triangle below `limit2` (squared). `start`: a triangle to begin with, or block -1.
  TriangleHit (*nearest)(const TreeView&, const double* p, double limit2, TriangleHit start);
  /// Blocks with a triangle below `limit2` (squared) that is no more than `slack` farther than the nearest of those met
  /// before; the nearest triangles are always among them. Writes at most `most`, returns how many there are.
  std::size_t (*near)(const TreeView&, const double* p, double limit2, double slack, BlockHit* out, std::size_t most);
  /// Blocks whose node box is within `reach` of the segment p .. p + height * axis. Writes at most `most`, returns how
  /// many there are.
  std::size_t (*gather)(const TreeView&, const CapsuleView&, double reach, std::int32_t* out, std::size_t most);
  /// Nearest triangle among the groups of a window.
  TriangleHit (*nearest_in)(const TreeView&, const BoxGroup*, std::size_t groups, const double* p, double limit2,
                            TriangleHit start);
  /// Lanes of the window that the flute may come nearer to than sqrt(limit2), though the ball's centre does not: block
  /// and lane as 8 * block + lane. Writes at most `most`, returns how many there are.
  std::size_t (*beside_flute)(const TreeView&, const BoxGroup*, std::size_t groups, const CapsuleView&, double limit2,
                              std::int64_t* out, std::size_t most);
  /// Lower bound of the squared distance between the axis of the flute, from the ball's centre to its top, and the
  /// triangles, up to `limit2`.
  double (*along)(const TreeView&, const CapsuleView&, double limit2);
  /// Lower bounds of the distance between a frustum and the eight boxes of a node, or the eight triangles of a block.
  void (*frustum_to_boxes)(const MeshNode&, const FrustumView&, double* out);
  void (*frustum_to_triangles)(const TriangleBlock&, const FrustumView&, double* out);
  /// Lanes of the boxes that a ray meets, one a bit.
  unsigned (*ray_to_boxes)(const MeshNode&, const RayView&);
  RayLanes (*ray_to_triangles)(const TriangleBlock&, const RayView&);
};

/// The fastest set that this processor can run.
[[nodiscard]] const MeshKernels& mesh_kernels();
/// The set for any processor: what the other is compared with.
[[nodiscard]] const MeshKernels& plain_mesh_kernels();

}  // namespace toothpath::clearance
