// What friction could add to a position of a bevel pair that was found without it: a bound, not a solution. Units N,
// mm. Frame: that of BevelPair. Derivation: docs/loaded_contact.md 11.
#pragma once

#include "geometry/loaded/friction.h"
#include "geometry/loaded_bevel/loaded_bevel_pair.h"

namespace toothpath::loaded_bevel {

/// How both gears turn at the exact ratio, where they stand.
[[nodiscard]] loaded::Turning turning_of(const LoadedBevelPair& pair);

/// Every row of cells slides as its most pressed place does. @param mu  coefficient of friction, >= 0
[[nodiscard]] loaded::Friction friction_of(const LoadedBevelPair& pair, const loaded::LoadedPosition& position,
                                           double mu);

}  // namespace toothpath::loaded_bevel
