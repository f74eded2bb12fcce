// The inspection grid of a bevel gear, whose walls are one profile of a finger mill.
#pragma once

#include "geometry/bevel_gear/gear.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {

inline constexpr InspectionOptions kBevelInspection{7, 11, 0.02};
/// Of `side` in files.
inline constexpr FlankNames kWallNames{"L", "U"};

/// Points of both walls of space 0, side +1 for wall L: rows of equal height between the fillet and the tip, columns of
/// equal cone distance, from the apex. None in the groove.
[[nodiscard]] Result<std::vector<InspectionPoint>> bevel_inspection_grid(
    const bevel_gear::BevelGear& gear, const InspectionOptions& options = kBevelInspection);

}  // namespace toothpath::inspection
