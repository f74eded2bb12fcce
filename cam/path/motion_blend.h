// How far a point of the tool may be from the straight line between two moments of a motion.
#pragma once

#include "cam/path/tool_motion.h"

namespace toothpath::path {

/// How far a point `arm_mm` along the tool axis may leave the straight line between its two places when a share `dt` of
/// the motion is passed through: the stated deviations, and the arc of an axis that turns. mm
[[nodiscard]] double line_slack(const ToolMotion& motion, double arm_mm, double dt);

}  // namespace toothpath::path
