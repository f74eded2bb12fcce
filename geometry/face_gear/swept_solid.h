// Is a point of the gear blank cut away? Answered by turning the solid shaper past the point, without any equation of
// meshing: the judge of the closed-form surfaces wherever two of their sheets could be mistaken for each other.
#pragma once

#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Least distance of a point (gear frame, mm) to the solid shaper over its whole motion, normal to the involute: 0 on
/// the finished flank, > 0 in the material that remains, < 0 where it is cut away. Exact to 1e-12 of the point's radius
/// near the involute and the tip rounding; elsewhere of the right sign. Sampled at 48 places a shaper tooth and refined
/// around the lowest.
[[nodiscard]] double swept_clearance(const FaceGearSurface<double>& surface, const Vec3& point);

}  // namespace toothpath::face_gear
