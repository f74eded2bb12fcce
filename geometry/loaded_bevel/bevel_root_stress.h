// Stress in the fillets of a bevel pair under the forces of a loaded cycle. The fillets are those that the corner arcs
// of the mills leave. Units N, mm, MPa. Derivation: docs/loaded_contact.md 10.
#pragma once

#include "geometry/loaded/root_stress.h"
#include "geometry/loaded_bevel/loaded_bevel_pair.h"

namespace toothpath::loaded_bevel {

/// The fillet of one body. @param half  index into LoadedBevelPair::halves. Refused: bricks that fold.
[[nodiscard]] Result<loaded::RootBody> root_body(const LoadedBevelPair& pair, std::size_t half, bool on_wheel,
                                                 const elastic::SectorPlan& plan);

/// Of both gears and all halves; `gear` is the wheel. Refused: bricks that fold, with the gear and its half; a mill
/// with a sharp tip: its fillets have no radius.
[[nodiscard]] Result<loaded::RootStress> root_stress(const LoadedBevelPair& pair, const loaded::LoadedCycle& cycle);

}  // namespace toothpath::loaded_bevel
