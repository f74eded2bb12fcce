// How solids stand to each other: the gap between two surfaces, and how far one reaches out of others.
#pragma once

#include <span>
#include <vector>

#include "cam/clearance/distance.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::clearance {

/// A mesh with its tree.
struct MeasuredMesh {
  const mesh::TriangleMesh& mesh;
  const MeshDistance& distance;
};

/// Least distance between two closed surfaces [mm], up to `within`; 0 where they meet. Of solids that lie one in the
/// other it is the gap between the surfaces.
[[nodiscard]] double surface_gap(const MeasuredMesh& a, const MeasuredMesh& b, double within);

struct OutsidePlace {
  double out_mm = 0;  ///< <= 0: inside, or on the surface
  Vec3 place = Vec3::Zero();
};

/// Where a surface reaches farthest out of the union of closed solids. Looked at are the corners of its facets, and
/// places in them so close together that nothing else of it reaches farther by more than `apart_mm`.
/// @param counts  one a vertex: facets with a corner that does not count are not looked at but for their other corners
[[nodiscard]] OutsidePlace farthest_outside(const mesh::TriangleMesh& surface, const std::vector<bool>& counts,
                                            std::span<const MeshDistance* const> solids, double apart_mm);

/// Distance of p to the union of closed solids, negative inside: there the depth in the solid that holds it best, at
/// most `deep`.
[[nodiscard]] double signed_distance(const Vec3& p, std::span<const MeshDistance* const> solids, double deep);

}  // namespace toothpath::clearance
