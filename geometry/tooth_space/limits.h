// What a shop asks of a tooth space before it chooses tools, measured on the exact surface.
#pragma once

#include "geometry/tooth_space/curvature.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// At one station. mm; 0 where a piece has no place there.
struct SpaceLimits {
  double fillet_radius_min_mm = 0;  ///< least concave radius of the fillet of a side
  double root_ball_radius_mm = 0;   ///< of the largest ball that stands on the middle of the root between the walls
};
/// @param side  whose fillet
[[nodiscard]] SpaceLimits limits_at(const ToothSpace& space, double s, int side);

/// The place of a piece at u and s; nothing where it is not found.
[[nodiscard]] std::optional<PatchPoint> place_at(const ToothSpace& space, Piece piece, double u, double s);

/// Half way up the flank of a side between fillet and tip, at s; nothing where that is not found.
[[nodiscard]] std::optional<PatchPoint> middle_of_flank(const ToothSpace& space, int side, double s);

}  // namespace toothpath::tooth_space
