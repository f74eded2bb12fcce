// The skin of a gear as exact surfaces, from its tooth spaces.
#pragma once

#include "geometry/exchange/shell.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::exchange {

/// Flanks, fillets, root and tip surface of every ring, and what is turned between and below them. Rings of which
/// fillets meet have no root strip. The spaces of the gear must outlive it. Refused: a groove without width, or with a
/// floor that all but meets the root beside it; lands that are too narrow for a face; a section that does not close
/// (undercut, pointed).
[[nodiscard]] Result<GearShell> tooth_shell(const tooth_space::ToothedSolid& gear);

}  // namespace toothpath::exchange
