// Inspection points of a gear that can be made, for tests that measure flanks.
#pragma once

#include <vector>

#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/grid.h"

namespace toothpath::test {

/// rows x columns points of every flank.
inline std::vector<inspection::InspectionPoint> grid_of(const face_gear::FaceGear& gear, int rows, int columns) {
  inspection::InspectionOptions options;
  options.rows = rows;
  options.columns = columns;
  return *inspection_grid(drawn_solid(gear), options);
}

}  // namespace toothpath::test
