// The plain triangle mesh that meshing, mesh files and mesh checks hand to each other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::mesh {

/// Indexed triangles in mm. Corners run counter-clockwise seen from outside the solid.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< indices into `vertices`

  /// Corner `corner` (0, 1, 2) of triangle `triangle`.
  [[nodiscard]] const Vec3& corner(std::size_t triangle, std::size_t corner_index) const {
    return vertices[static_cast<std::size_t>(triangles[triangle][corner_index])];
  }
  /// (p1 - p0) x (p2 - p0): outward, as long as twice the area.
  [[nodiscard]] Vec3 area_normal(std::size_t triangle) const {
    const Vec3& p = corner(triangle, 0);
    return (corner(triangle, 1) - p).cross(corner(triangle, 2) - p);
  }
};

/// Volume enclosed by a closed mesh [mm^3], positive when the normals point outwards.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

}  // namespace toothpath::mesh
