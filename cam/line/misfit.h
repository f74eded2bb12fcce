// How far the side of a mill stands off the flank where its records put it: looked at more densely than it was planned.
#pragma once

#include "cam/line/passes.h"

namespace toothpath::line {

/// Largest gap over the strip as a pass is cut, mm: at all of its records, 64 heights each, and at seven places of
/// every block between two of them, 16 heights each. The bias that the poses keep is in it.
[[nodiscard]] double largest_gap(const LineFit& fit, const LinePass& pass);

}  // namespace toothpath::line
