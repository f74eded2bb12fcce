// One position of a loaded pair on cells: flanks that touch in a point, or on an edge. docs/loaded_contact.md 5.
#pragma once

#include "geometry/loaded/cell_flanks.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

/// As `loaded_position`, for any pair of gears, with the pressures on rectangular cells about the place of least gap of
/// every tooth. A segment of the result is a row of cells: its half width is that of the pressed cells, its pressure
/// the largest of them. Refused: no pair touches; pressures that do not settle; a contact that outgrows its cells.
[[nodiscard]] Result<LoadedPosition> cell_position(const CellFlanks& flanks, const Load& load, double phi);

}  // namespace toothpath::loaded
