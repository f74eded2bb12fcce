// Nominal points and normals of the flanks for a coordinate measuring machine.
#pragma once

#include <string>
#include <vector>

#include "geometry/face_gear/gear.h"

namespace toothpath::inspection {

struct InspectionOptions {
  int rows = 5;          ///< along the profile, 5 .. 1000
  int columns = 9;       ///< along the face width, 9 .. 1000
  double margin = 0.05;  ///< part of the profile and of the face width kept clear at each edge, 0 .. 0.4
};

/// One nominal point of tooth 0, gear frame.
struct InspectionPoint {
  int zone = 0;    ///< ring, from the inside
  int side = 1;    ///< +1 or -1
  int row = 0;     ///< 0: nearest the fillet; grows towards the tip
  int column = 0;  ///< 0: nearest the gear axis
  double theta = 0, B = 0;
  Vec3 p = Vec3::Zero();  ///< mm
  Vec3 n = Vec3::Zero();  ///< unit normal out of the material
};

/// Points of both flanks of tooth 0 of every ring, ordered by zone, side (+1, -1), row, column. The columns are circles
/// r = const, evenly spaced; on each the rows are even in theta between the fillet line and the tip or, where the tip
/// lies inside the base circle, the start of the involute. Refused: options outside their range; a radius where the
/// flank does not reach from tip to fillet.
[[nodiscard]] Result<std::vector<InspectionPoint>> inspection_grid(const face_gear::FaceGear& gear,
                                                                   const InspectionOptions& options = {});

/// Lines `zone,flank,row,column,x,y,z,i,j,k` with that header; 13 significant digits; lines end in "\n".
[[nodiscard]] std::string inspection_csv(const std::vector<InspectionPoint>& points);

}  // namespace toothpath::inspection
