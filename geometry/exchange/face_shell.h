// The skin of a face gear as exact surfaces.
#pragma once

#include "geometry/exchange/shell.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::exchange {

/// Nominal flanks, fillets, root and tip surface of every ring; end faces, groove floor, inside, outside and underside
/// as those of geometry/mesh/tooth_mesh.h. Rings of which fillets meet have no root strip. Refused: a groove without
/// width, or with a floor that all but meets the root beside it; lands that are too narrow for a face; a section that
/// does not close (undercut, pointed).
[[nodiscard]] Result<GearShell> face_gear_shell(const face_gear::FaceGear& gear);

}  // namespace toothpath::exchange
