// The triangles of a mesh as an 8-wide tree: boxes of eight children, and leaves of eight triangles in
// structure-of-arrays form, all in double. The kernels of cam/clearance/kernels.h walk over it. Median splits along the
// longest extent of the centroids.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/clearance/kernels.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::clearance {

class MeshTree {
 public:
  explicit MeshTree(const mesh::TriangleMesh& mesh);

  [[nodiscard]] const std::vector<MeshNode>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<TriangleBlock>& blocks() const { return blocks_; }
  [[nodiscard]] const std::vector<BlockBox>& boxes() const { return boxes_; }
  /// Index in the mesh of a lane of a block.
  [[nodiscard]] std::size_t triangle(std::size_t block, int lane) const {
    return order_[block * kLanes + std::size_t(lane)];
  }
  /// Origin of the tree's frame in the frame of the mesh: the middle of its box, so that coordinates are short.
  [[nodiscard]] const Vec3& origin() const { return origin_; }
  [[nodiscard]] std::size_t triangles() const { return count_; }

 private:
  struct Range {
    std::size_t from, to;
  };
  std::int32_t build(Range range, Vec3& low, Vec3& high);
  std::int32_t block_of(Range range, Vec3& low, Vec3& high);
  std::size_t split(Range range);

  const mesh::TriangleMesh* mesh_ = nullptr;
  std::vector<Vec3> centroids_;
  std::vector<std::uint32_t> order_, sorted_;
  std::vector<MeshNode> nodes_;
  std::vector<TriangleBlock> blocks_;
  std::vector<BlockBox> boxes_;
  Vec3 origin_ = Vec3::Zero();
  std::size_t count_ = 0;
};

}  // namespace toothpath::clearance
