// Is a triangle mesh a solid? Answers with exact predicates. The only room that knows CGAL.
#pragma once

#include <array>
#include <cstddef>

#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::mesh {

/// What was found. A solid is manifold, closed, outward and has no self-intersections.
struct MeshCheck {
  bool manifold = false;  ///< every edge has at most two triangles, of one orientation; every vertex one fan
  bool closed = false;    ///< no border edge; false when not manifold
  bool outward = false;   ///< normals point out of the bounded side; false when not closed
  std::size_t self_intersections = 0;               ///< pairs of triangles that cross or overlap, up to a limit;
                                                    ///< not looked for when not manifold
  std::array<std::size_t, 2> first_intersection{};  ///< triangles of the first pair
  std::size_t components = 0;                       ///< connected pieces
  double volume_mm3 = 0;                            ///< signed; 0 when not closed

  [[nodiscard]] bool is_solid() const { return manifold && closed && outward && self_intersections == 0; }
};

struct MeshCheckOptions {
  bool self_intersections = true;  ///< look for crossing triangles: the slow part, about 0.3 s for 200 000 triangles
  std::size_t most_pairs = 1000;   ///< stop counting here
  /// Pairs of triangles whose boxes meet and that are therefore compared, about 10 million a second. Even triangles
  /// have some ten each; millions of slivers have them by the square.
  std::size_t most_compared = 50'000'000, most_compared_each = 40;  ///< the larger of both counts
};

/// Checks a mesh whose vertices are already shared (welded). Refused: an index outside the vertices, a coordinate that
/// is not finite, no triangle at all, more pairs to compare than the options allow.
[[nodiscard]] Result<MeshCheck> check_mesh(const TriangleMesh& mesh, const MeshCheckOptions& options = {});

}  // namespace toothpath::mesh
