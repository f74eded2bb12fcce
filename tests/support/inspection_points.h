// Inspection points of a gear that can be made, for tests that measure flanks.
#pragma once

#include <vector>

#include "geometry/face_gear.h"
#include "geometry/inspection_grid.h"

namespace toothpath::test {

/// rows x columns points of every flank.
inline std::vector<InspectionPoint> grid_of(const FaceGear& gear, int rows, int columns) {
  InspectionOptions options;
  options.rows = rows;
  options.columns = columns;
  return *inspection_grid(gear, options);
}

}  // namespace toothpath::test
