// Meshes and inspection points of the equal-base-circle bevel gear, from its exact walls.
//
// Structured: stations of equal cone distance along the face (both edges of the relief groove among them), and on each
// a loop of points wall L, root, wall U, top land, for every tooth space. The body below is a ring parallel to the
// pitch cone. Blank frame, mm.
#pragma once

#include <string>
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

/// Nominal point of a wall of tooth space 0.
struct BevelInspectionPoint {
  int half = 0;                             ///< zone, from the inside
  int sigma = 1;                            ///< +1: flank L, -1: flank U
  int row = 0;                              ///< 0: nearest the fillet
  int column = 0;                           ///< 0: nearest the apex
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();  ///< mm; unit, out of the material
};
struct BevelInspectionOptions {
  int rows = 7, columns = 11;
  double margin = 0.02;  ///< part of profile and face kept clear at each edge
};
/// Rows of equal height between the fillet and the tip, columns of equal cone distance. None in the groove.
[[nodiscard]] Result<std::vector<BevelInspectionPoint>> bevel_inspection_grid(
    const bevel_gear::BevelGear& gear, const BevelInspectionOptions& options = {});
/// Lines `zone,flank,row,column,x,y,z,i,j,k` with that header, flank L or U, 13 significant digits.
[[nodiscard]] std::string bevel_inspection_csv(const std::vector<BevelInspectionPoint>& points);

}  // namespace toothpath::mesh
