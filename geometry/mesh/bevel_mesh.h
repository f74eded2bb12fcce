// Meshes of the equal-base-circle bevel gear, from its exact walls.
//
// Structured: stations of equal cone distance along the face (both edges of the relief groove among them), and on each
// a loop of points wall L, root, wall U, top land, for every tooth space. The body below is a ring parallel to the
// pitch cone. Blank frame, mm.
#pragma once

#include <vector>

#include "geometry/bevel_gear/gear.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::mesh {

/// Height over the pitch cone of the underside that bodies of ours have, mm: how thick a gear is below its teeth no job
/// says.
[[nodiscard]] double underside_height(const bevel_gear::BevelGear& gear);

struct BevelMeshOptions {
  int stations = 21;                     ///< along the face of each half, 2 ..
  int rows = 19;                         ///< along the profile of a wall, 3 ..
  int root_points = 4, land_points = 3;  ///< inside root and top land
};

/// The finished gear, all teeth: closed, outward. Refused: a wall that does not reach from root to tip at some station.
[[nodiscard]] Result<TriangleMesh> bevel_gear_mesh(const bevel_gear::BevelGear& gear,
                                                   const BevelMeshOptions& options = {});

/// One of its `teeth` equal parts, with its share of the body: open where the next one joins.
[[nodiscard]] Result<TriangleMesh> bevel_pitch_part(const bevel_gear::BevelGear& gear,
                                                    const BevelMeshOptions& options = {});

/// One pitch of the tooth surface (walls, root, top land, groove), open. `patch` gets a number a vertex: 0 wall L, 1
/// root, 2 wall U, 3 top land, 4 groove.
[[nodiscard]] Result<TriangleMesh> bevel_pitch_mesh(const bevel_gear::BevelGear& gear, std::vector<double>& patch,
                                                    const BevelMeshOptions& options = {});

}  // namespace toothpath::mesh
