// Axes for a ball end that cuts beside a flank which the side of the same mill has cut: those poses, turned away from
// the flank by a little. Set-up errors of the tilted poses then leave no step at the fillet line, and the cone does not
// rub where the ball goes on below it.
#pragma once

#include "cam/ball/plan.h"
#include "cam/line/plan.h"
#include "geometry/base/angle.h"

namespace toothpath::plan {

/// How far off the flank the axes are tried, rad: the most that clears is taken.
inline constexpr double kOffFlank[] = {0.3 * kDegree, 0.2 * kDegree, 0.1 * kDegree, 0.05 * kDegree};

/// The poses of the lowest strip of every flank as keys along the teeth, zone by zone, for every angle of `kOffFlank`.
[[nodiscard]] ball::Leading beside_side(const analytic::GearDistance& part, const line::LinePlan& side, int operation);

}  // namespace toothpath::plan
