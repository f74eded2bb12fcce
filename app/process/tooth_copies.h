// Teeth of a program that are written out one by one: those that are the first tooth again, turned, need not be proven
// again.
#pragma once

#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/proof/like_motion.h"

namespace toothpath::process {

/// Cutting motions of a tooth are left out where every operation cuts it as it cuts its own first tooth, turned about
/// the gear axis, to within the tolerance at every moment of every block, up to a metre from the tip. How far tip and
/// axis are found away is added to the deviations of the first tooth's motions, so that what is proven of these holds
/// for all. Rapids, and teeth that differ anywhere, are kept as they are.
/// @param motions  in program order, W; @param teeth  of the gear
[[nodiscard]] std::vector<path::ToolMotion> without_copies(std::vector<path::ToolMotion> motions, int teeth,
                                                           double tolerance_mm);

/// Cutting motions of later teeth that go within 0.1 mm of their operation's first tooth, however either is cut into
/// blocks, in the order of the motions. What is proven of the first tooth tells of them all but this distance.
/// @param motions, teeth  as above
[[nodiscard]] std::vector<proof::LikeMotion> like_motions(const std::vector<path::ToolMotion>& motions, int teeth);

}  // namespace toothpath::process
