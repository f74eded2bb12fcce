// The turned body that a toothed gear is cut from.
#pragma once

#include "cam/rest/rest_mesh.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::rest {

/// Its pitches begin at azimuth 0. The spaces of the gear must outlive it. @param above_mm stock on the tip surface
[[nodiscard]] Blank blank_of(const tooth_space::ToothedSolid& gear, double above_mm = 0);

}  // namespace toothpath::rest
