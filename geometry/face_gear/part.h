// A face gear as planners and proofs ask for it.
#pragma once

#include <memory>

#include "geometry/face_gear/gear.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::face_gear {

/// Corrections of the gear included; the gear is copied.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const FaceGear& gear);

/// Height z of the underside that bodies of ours have, mm: how thick a gear is below its teeth no job says. 2.5 modules
/// below the lowest point of the teeth and the groove.
[[nodiscard]] double underside_z(const FaceGear& gear);

/// The gear of the drawing, without corrections, which must outlive it: inside, outside and underside are turned.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const FaceGear& gear);

}  // namespace toothpath::face_gear
