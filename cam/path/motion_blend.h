// How far a point of the tool may be from the straight line between two moments of a motion, and how far a straight
// line from a way about the gear axis.
#pragma once

#include "cam/path/tool_motion.h"

namespace toothpath::path {

/// How far a point `arm_mm` along the tool axis may leave the straight line between its two places when a share `dt` of
/// the motion is passed through: the stated deviations, and the arc of an axis that turns. mm
[[nodiscard]] double line_slack(const ToolMotion& motion, double arm_mm, double dt);

/// So many straight pieces of a way about the z axis come no nearer to it than their ends by more than `dip_mm`, > 0.
[[nodiscard]] int pieces_about_axis(const Vec3& from, const Vec3& to, double dip_mm);

}  // namespace toothpath::path
