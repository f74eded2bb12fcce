// One half of a bevel pair as a deck of CalculiX: rows of teeth where they stand, the wheel's clamped nodes turned.
#pragma once

#include <string>

#include "geometry/loaded_bevel/loaded_bevel_pair.h"

namespace toothpath::decks {

struct BevelDeckOptions {
  elastic::SectorPlan wheel = {4, 12, 3, 1, 3, 8, 25, 2}, pinion = {4, 12, 3, 1, 3, 8, 25, 2};
  int teeth = 3;           ///< of the row, odd
  int tooth = 0;           ///< pair in the middle of the rows
  double phi_1 = 0;        ///< turn of the pinion at the exact ratio; it stands where its first pair touches
  double approach_mm = 0;  ///< by which the wheel is turned against the pinion, at the nominal lever of the pair
};

/// As rows_deck: the moment of the reactions of GEAR_HELD about the wheel's axis is the torque.
/// Refused: as for the bricks; no pair touches.
[[nodiscard]] Result<std::string> bevel_deck(const loaded_bevel::LoadedBevelPair& pair, int half,
                                             const BevelDeckOptions& options);

}  // namespace toothpath::decks
