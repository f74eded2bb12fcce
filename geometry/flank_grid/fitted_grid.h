// From the points of two flanks to their tooth space: splines, the balls that roll below them, and what is wrong with
// any of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/flank_grid/grid_kernel.h"
#include "geometry/flank_grid/parameters.h"
#include "geometry/tooth_space/kernel_space.h"

namespace toothpath::flank_grid {

using GridSpace = tooth_space::KernelSpace<GridKernel>;

/// How well the points say what the flank is.
struct GridQuality {
  double going_on = 0;      ///< the largest share of height or length by which a flank goes on beyond its points
  double going_on_mm = 0;   ///< that way
  std::string going_on_at;  ///< where, in words
  std::optional<double> normals_rad;  ///< worst angle of a given normal to the spline's; none: no normals are given
  std::string normals_at;             ///< where
  double corners_mm = 0;              ///< the most by which a rounded corner of root or tip lies beside it
  std::string corners_at;             ///< where
  std::optional<double> spacing_mm;   ///< every second row and column left out: how far they lie beside the spline
};

struct FittedGrid {
  std::shared_ptr<const GridSpace> space;
  GridQuality quality;
};

/// Checks every limit of the gear. On failure returns all refusals; those of points have the place in their file.
[[nodiscard]] Expected<FittedGrid, std::vector<Refusal>> fit_grid(const FlankGridParameters& parameters);

/// The spline through a grid, its columns in the order of rising s; v is s in the middle of the rows.
/// Broken promise: fewer than 4 rows or columns, or neighbours in one place.
[[nodiscard]] Flank flank_through(const GridPoints& grid, int side, const tooth_space::Chart& chart);

/// How far the rows and columns that are left out lie beside the spline through every second one; nothing where that
/// leaves fewer than four either way.
[[nodiscard]] std::optional<double> spacing_error(const GridPoints& grid, int side, const tooth_space::Chart& chart);

/// Arc of the root between both fillets at s, mm.
[[nodiscard]] double root_land_mm(const GridSpace& space, double s);

}  // namespace toothpath::flank_grid
