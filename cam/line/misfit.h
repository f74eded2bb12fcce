// What the side of a mill leaves of a flank as its records put it: looked at more densely than it was planned.
#pragma once

#include <span>

#include "cam/line/passes.h"
#include "cam/tool/profile.h"

namespace toothpath::line {

/// Sets `left_mm` and `unpassed_mm` of the passes of one flank, its strips from the tip down.
///
/// `left_mm`: a bound of what stands above the allowance along the normals of the strip when all strips are cut, at
/// most a module. It is looked at where the feet of the axis are, at 64 heights of every record, at 16 of seven places
/// of every block between two of them, and about the largest of these; and where no foot may come, at the ends of the
/// ring and, under a lifted ball end, at the fillet line. `unpassed_mm`: of that what was planned at the ends, by the
/// last pose of a pass that does not reach them.
void measure_left(const FlankTask& flank, const tool::Profile& tool, std::span<LinePass> strips);

}  // namespace toothpath::line
