// The walls of the job's gear as they were cut or measured: what stands on the drawn ones, for the pair that is rolled
// and loaded.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/job/measured_file.h"
#include "app/process/cut_flanks.h"
#include "app/process/gear_of_job.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/contact/bevel_contact.h"

namespace toothpath::bevel {

struct CutWalls {
  std::string route;  ///< "milled" or "measured"
  /// Of wall sigma of a half at a place (cone distance, height over the pitch cone), mm: > 0 material left.
  std::function<double(int half, int sigma, const bevel_gear::ConePoint& at)> left;
  std::vector<std::string> notes;
};

/// Bilinear on the grid of the cut surface, beyond it that of its rim. Refused: a wall without a grid; a column of it
/// that the mill does not reach.
[[nodiscard]] Result<CutWalls> walls_as_cut(const bevel_gear::BevelGear& gear, const process::CutFlanks& cut);

/// The fit of measured grids (inspection.csv with a column deviation_um). Refused: as job::fit_measured.
[[nodiscard]] Result<CutWalls> walls_as_measured(const bevel_gear::BevelGear& gear, const job::MeasuredInput& measured);

/// The walls as flanks on grids up to their borders, as any two gears roll. Refused: as
/// inspection::bevel_inspection_grid.
[[nodiscard]] Result<process::CutFlanks> flanks_of(const bevel_gear::BevelGear& gear, const CutWalls& walls);

/// What the pair meets of it: the mate is as drawn. Keeps a copy.
[[nodiscard]] contact::BevelLeft left_on_pair(const CutWalls& walls, bool of_pinion);

}  // namespace toothpath::bevel
