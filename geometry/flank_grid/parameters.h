// What defines a gear by points: the numbers of a job's [gear] table and the file that it names, in mm and rad.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::flank_grid {

/// One flank: rows from the root to the tip, columns along the tooth; row by row.
struct GridPoints {
  int rows = 0, columns = 0;
  std::vector<Vec3> place;
  std::vector<Vec3> normal;  ///< out of the material; empty: none are given
  std::vector<int> line;     ///< of the file; empty: the points come from no file
  [[nodiscard]] std::size_t index(int row, int column) const { return std::size_t(row * columns + column); }
};

struct FlankGridParameters {
  int teeth = 0;
  std::string file;        ///< of the points, for messages
  GridPoints plus, minus;  ///< flanks 1 and -1 of one space
  double fillet_radius_mm = 0;
  std::vector<Vec2> root, tip;  ///< (r, z) from the end of column 0 to the other
  double bore_diameter_mm = 0, hub_diameter_mm = 0, hub_length_mm = 0;  ///< 0: none
  [[nodiscard]] const GridPoints& points(int side) const { return side > 0 ? plus : minus; }
};

}  // namespace toothpath::flank_grid
