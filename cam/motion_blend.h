// Where the tool is at a moment of a motion, and how far a point of it may be from the straight line between two moments.
#pragma once

#include "cam/tool_motion.h"

namespace toothpath {

/// Tip at t in [0, 1], straight. mm
[[nodiscard]] inline Vec3 tip_at(const ToolMotion& motion, double t) { return (1 - t) * motion.tip_from + t * motion.tip_to; }

/// Normalised linear blend of the axes of a motion, t in [0, 1].
[[nodiscard]] Vec3 axis_at(const ToolMotion& motion, double t);

/// How far a point `arm_mm` along the tool axis may leave the straight line between its two places when a share `dt` of the
/// motion is passed through: the stated deviations, and the arc of an axis that turns. mm
[[nodiscard]] double line_slack(const ToolMotion& motion, double arm_mm, double dt);

}  // namespace toothpath
