// The walls of an equal-base-circle bevel gear alone, whether it can be cut or not: what fits ask for.
#pragma once

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

/// The halves with their walls, without a look at the limits that BevelGear::make checks; limits() and warnings() of it
/// stay empty. Refused: numbers that make no walls.
[[nodiscard]] Expected<BevelGear, std::vector<Refusal>> walls_of(const BevelGearParameters& parameters,
                                                                 const FingerCutterData& cutter);

}  // namespace toothpath::bevel_gear
