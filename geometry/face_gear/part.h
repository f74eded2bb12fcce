// A face gear as planners and proofs ask for it.
#pragma once

#include <memory>

#include "geometry/face_gear/gear.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::face_gear {

/// The face gear of such a part; the part is one.
[[nodiscard]] const FaceGear& gear_of(const tooth_space::ToothedPart& part);
/// Corrections of the gear included; the gear is copied.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const FaceGear& gear);

}  // namespace toothpath::face_gear
