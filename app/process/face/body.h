// The turned body of a face gear, as its milling asks for it.
#pragma once

#include "app/process/milled/body.h"
#include "geometry/face_gear/body.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::face {

/// Links keep clear of a cylinder from the underside of the body to the top of the stock, rapids of the rings. The gear
/// must outlive it.
[[nodiscard]] milled::GearBody body_of(const face_gear::FaceGear& gear, const face_gear::Body& drawn = {});

}  // namespace toothpath::face
