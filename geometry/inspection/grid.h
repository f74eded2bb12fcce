// Nominal points and normals of the flanks for a coordinate measuring machine.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::inspection {

struct InspectionOptions {
  int rows = 5;          ///< along the profile, 5 .. 1000
  int columns = 9;       ///< along the face width, 9 .. 1000
  double margin = 0.05;  ///< part of the profile and of the face width kept clear at each edge, 0 .. 0.4
};

/// One nominal point of a flank, gear frame.
struct InspectionPoint {
  int zone = 0;             ///< of the job
  int side = 1;             ///< +1 or -1
  int row = 0;              ///< 0: nearest the fillet; grows towards the tip
  int column = 0;           ///< 0: nearest the first end of the ring: the gear axis, or the upper end
  double theta = 0, B = 0;  ///< parameters (u, v) of the flank; theta: a roll angle
  Vec3 p = Vec3::Zero();    ///< mm
  Vec3 n = Vec3::Zero();    ///< unit normal out of the material
};

/// Points of both flanks of every ring, ordered by zone, side (+1, -1), row, column: of tooth 0, or those that bound
/// space 0. The columns are stations s = const, evenly spaced; on each the rows are even in u between the fillet line
/// and the tip or, where that lies beyond, the begin of the flank. Refused: options outside their range; a station
/// where the flank does not reach from tip to fillet.
[[nodiscard]] Result<std::vector<InspectionPoint>> inspection_grid(const tooth_space::ToothedSolid& gear,
                                                                   const InspectionOptions& options = {});
/// What the sides +1 and -1 are called in files.
struct FlankNames {
  const char *plus = "1", *minus = "-1";
};
/// Lines `zone,flank,row,column,x,y,z,i,j,k` with that header; 13 significant digits; lines end in "\n".
[[nodiscard]] std::string inspection_csv(const std::vector<InspectionPoint>& points, const FlankNames& names = {});

}  // namespace toothpath::inspection
