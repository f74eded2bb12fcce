// Ease-off of a bevel pair, and where its pattern lies when it stands off its place: ease_off.h and pattern_place.h for
// walls.
//
// Of the two gears the wheel's walls carry the grid, as a face gear's flanks do. A turn of the pinion is as many
// micrometres as its lever is long there, and the lever grows along the face: flanks are brought to touch by a turn.
// Derivation: docs/ease_off.md 5.
#pragma once

#include <array>

#include "geometry/contact/bevel_contact.h"
#include "geometry/contact/pattern_place.h"

namespace toothpath::contact {

/// The words of [contact] for a bevel pair: the wheel moved across the pinion's teeth and along its own axis, the
/// pinion along its own, both away from the common apex; the angle is added to that between the shafts.
[[nodiscard]] BevelAssembly assembly_of(const Misalignment& moved);

/// Walls of one sigma, half by half.
struct BevelEaseOff {
  std::vector<BevelPattern> grids;  ///< places only
  EaseOff found;                    ///< a map a half; levers of the pinion
  /// Parameters of the pinion's wall that each place mates with: a step of the wheel's turn before it is nearest, then,
  /// and after; NaN where the pinion's flank has ended by then.
  std::vector<std::vector<std::array<bevel_gear::BevelInverse, 3>>> mates;
  double step_rad = 0;
};
/// Distances are square to the pinion's wall. Refused: no place with a common normal.
[[nodiscard]] Result<BevelEaseOff> bevel_ease_off(const BevelPair& pair, int sigma, int rows, int columns);

/// How far beyond the margins a place of the wheel's wall lies: of the edges of the wall, of those of the pinion's.
/// @param beside  of the pinion where it is nearest to a place without a common normal
[[nodiscard]] BeyondMargins bevel_beyond_margins(const BevelPair& pair, const BevelPattern& grid, const EaseOffMap& map,
                                                 std::size_t place, double margin, const bevel_gear::ConePoint& beside);

/// Marks weigh as much as their places have of the wall's cone distances and heights.
/// @param rolled  of the grid of the map, with gaps
[[nodiscard]] PatternPlace bevel_pattern_place(const BevelPair& pair, const BevelPattern& rolled, const EaseOffMap& map,
                                               double compound_mm, double margin);

/// Rolls wall sigma of a pair that stands off its place; its error is the pinion's. Refused: as BevelPair::make and
/// bevel_contact; no place with a common normal.
[[nodiscard]] Result<MisalignedContact> bevel_misaligned_contact(const bevel_gear::BevelGear& pinion,
                                                                 const bevel_gear::BevelGear& wheel, int sigma,
                                                                 const Misalignment& moved,
                                                                 const BevelContactOptions& options, double margin);

}  // namespace toothpath::contact
