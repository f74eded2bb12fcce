// How large a first roughing tool may be.
#pragma once

#include "cam/analytic/gear_distance.h"

namespace toothpath::plan {

/// Diameter of the largest ball that fits upright in the middle of a space with its lowest point at half the height and
/// keeps the allowance everywhere, in the middle and at both ends of every ring. Most of the material lies above that
/// height. Found to 1e-3 mm. mm
/// @param reach_mm  that `part` was made for: where ball and allowance fill it, a larger one is told as that
[[nodiscard]] double first_ball_mm(const analytic::GearDistance& part, double allowance_mm, double reach_mm);

}  // namespace toothpath::plan
