// Images of cells at the free ends of teeth. docs/loaded_contact.md 5.
#pragma once

#include "geometry/loaded/cell_contact.h"
#include "geometry/loaded/cell_flanks.h"

namespace toothpath::loaded {

/// Adds the images of blocks of 4 x 4 cells at the free ends of both bodies, where an end is near, to the window of a
/// site. @param places  of the window's cells
void add_images(const CellBodies& bodies, const CellSite& site, const std::vector<CellPlace>& places,
                CellWindow& window);

}  // namespace toothpath::loaded
