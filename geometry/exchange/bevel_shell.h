// The skin of an equal-base-circle bevel gear as exact surfaces.
#pragma once

#include "geometry/bevel_gear/gear.h"
#include "geometry/exchange/shell.h"

namespace toothpath::exchange {

/// Walls as the envelope of the finger mill (fillet of its corner, straight, involute), root, top land; ends of the
/// teeth, groove floor and body as those of geometry/mesh/bevel_mesh.h. Refused: a wall that does not reach from root
/// to tip, pointed teeth.
[[nodiscard]] Result<GearShell> bevel_gear_shell(const bevel_gear::BevelGear& gear);

}  // namespace toothpath::exchange
