// Teeth of a program that are written out one by one: those that are the first tooth again, turned, need not be proven
// again.
#pragma once

#include <vector>

#include "cam/path/tool_motion.h"

namespace toothpath::process {

/// Cutting motions of a tooth are left out where every operation cuts it as it cuts its own first tooth, turned about
/// the gear axis, to within half a micrometre at every moment of every block. The distance found is added to the
/// deviation of the first tooth's motions, so that what is proven of these holds for all. Rapids, and teeth that differ
/// anywhere, are kept as they are.
/// @param motions  in program order, W; @param teeth  of the gear
[[nodiscard]] std::vector<path::ToolMotion> without_copies(std::vector<path::ToolMotion> motions, int teeth,
                                                           double tolerance_mm);

}  // namespace toothpath::process
