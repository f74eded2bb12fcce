// What a shop asks of a tooth space before it chooses tools, measured on the exact surface.
#pragma once

#include "geometry/tooth_space/curvature.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// Least concave radius of the fillet of a side at s; 0 where it has no place. mm
[[nodiscard]] double fillet_radius_min_mm(const ToothSpace& space, double s, int side);
/// Radius of the largest ball that touches the root at s between the walls; 0 where the root has no place. mm
[[nodiscard]] double root_ball_radius_mm(const ToothSpace& space, double s);

/// Arc of the top land between two spaces on the tip surface at s; 0 where the flanks do not reach that. mm
[[nodiscard]] double top_land_mm(const ToothSpace& space, double s);

/// v of a piece at u and s, and the place there; nothing where it is not found.
[[nodiscard]] std::optional<double> v_at(const ToothSpace& space, Piece piece, double u, double s);
/// v of a piece at u and a station of the outline; s is that of the station at the height of the place.
[[nodiscard]] std::optional<double> v_at_station(const ToothSpace& space, Piece piece, double u, double station);
[[nodiscard]] std::optional<PatchPoint> place_at(const ToothSpace& space, Piece piece, double u, double s);

/// Half way up the flank of a side between fillet and tip, at s; nothing where that is not found.
[[nodiscard]] std::optional<PatchPoint> middle_of_flank(const ToothSpace& space, int side, double s);

}  // namespace toothpath::tooth_space
