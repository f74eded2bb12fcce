// Where the rows and columns of a tooth mesh stand: dense where the surface bends, from a probe of its second
// differences.
#pragma once

#include <array>
#include <vector>

#include "geometry/mesh/tooth_section.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::mesh {

/// Grid lines of one pitch: rows are stations along the teeth, columns are fractions of the segments of a section.
struct ToothGrid {
  std::array<std::vector<double>, kSegmentCount> fractions;  ///< 0 .. 1 increasing, the same for all rings
  std::vector<std::vector<double>> stations;                 ///< one list a ring, s from end to end, mm

  /// Cells across one pitch.
  [[nodiscard]] std::size_t columns() const;
  /// Triangles on the toothed surface of all rings.
  [[nodiscard]] std::size_t surface_triangles() const;
};

/// One column of the grid: segment and the two fractions that bound the cell to its right.
struct GridColumn {
  std::size_t segment = 0;
  double from = 0, to = 1;
  std::size_t slot = 0;  ///< of its left line among the (columns + segments) lines, common ends counted twice
};
[[nodiscard]] std::vector<GridColumn> grid_columns(const ToothGrid& grid);

/// How strongly the outline and the lines along the tooth bend, sampled once per gear.
class GridPlanner {
 public:
  /// Refused: as `ToothSection::at`.
  static Result<GridPlanner> probe(const tooth_space::ToothedSolid& gear);

  /// Grid whose cells sag by about `sag_mm` in each of the two directions.
  [[nodiscard]] ToothGrid grid(double sag_mm) const;

 private:
  std::array<std::vector<double>, kSegmentCount> bend_across_;  ///< second derivative by fraction, mm
  std::vector<std::vector<double>> bend_along_;  ///< the same by the root of the fraction of the face width,
                                                 ///< one list a ring
  std::vector<std::array<double, 2>> span_;      ///< s of both ends of each ring
};

}  // namespace toothpath::mesh
