// A face gear as planners and proofs ask for it.
#pragma once

#include <memory>
#include <optional>

#include "geometry/face_gear/body.h"
#include "geometry/face_gear/gear.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::face_gear {

/// Corrections of the gear included; the gear is copied.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const FaceGear& gear);

/// What is wrong with a body of this gear, with the key of [stock]; nothing: it can be made.
[[nodiscard]] std::optional<Refusal> body_refusal(const FaceGear& gear, const Body& body);

/// Height z of the lowest face of the body, that of the hub where there is one; mm.
[[nodiscard]] double underside_z(const FaceGear& gear, const Body& body = {});

/// Height z to which the web between the bore and the teeth stands; nothing: there is none. mm.
[[nodiscard]] std::optional<double> web_z(const FaceGear& gear, const Body& body);

/// The gear of the drawing, without corrections, which must outlive it: inside, outside and underside are turned.
/// Precondition: body_refusal(gear, body) is nothing.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const FaceGear& gear, const Body& body = {});

}  // namespace toothpath::face_gear
