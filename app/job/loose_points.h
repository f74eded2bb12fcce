// Measured points of a gear's flanks in any order, read from all files in which machines and spreadsheets save them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/flank_grid/point_order.h"

namespace toothpath::job {

struct LoosePoints {
  std::string file;
  bool states_unit = false;                    ///< of x, y, z
  std::vector<flank_grid::LoosePoint> points;  ///< mm; all have normals or none has
};

/// Reads DMIS results and lists of x y z (geometry/inspection/point_file.h), the points file of a job (flank_points.h)
/// and inspection grids `zone,flank,row,column,x,y,z,i,j,k`, with `deviation_um` behind them or without: the point then
/// lies so far out along its normal.
/// @param unit_mm  of x, y, z as somebody says it; nothing: as the file says it, else mm
/// Refused: what the readers refuse, with line and column; points beside the axis; a unit that the file states
/// otherwise (kind usage).
[[nodiscard]] Result<LoosePoints> read_loose_points(const std::string& file, std::optional<double> unit_mm);

}  // namespace toothpath::job
