// Ease-off: how far a gear's flank stands off the flank that would run with its pinion at the exact ratio.
//
// While gear and pinion turn at the exact ratio the pinion's flank, modified and where it stands, sweeps an envelope in
// the gear: the conjugate flank. For a place of the gear the distance to the pinion's flank is closed form at every
// turn (pinion.h); its least over all turns is the normal distance to the envelope. Modifications and deviations of the
// gear and removals of the pinion add to it, unchanged. Derivation: docs/ease_off.md.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/contact/tooth_contact.h"

namespace toothpath::contact {

/// One flank; all lists as its grid. NaN: the flanks have no common normal there, the pinion's flank ends before.
struct EaseOffMap {
  EaseOffMap() = default;
  explicit EaseOffMap(std::size_t places);  ///< without a common normal anywhere; no levers
  std::vector<double> gap_mm;               ///< normal to the flank; the least of all members of a side is 0
  std::vector<double> phi_2;                ///< turn of the gear at which tooth 0 is nearest there, rad
  std::vector<double> bend_mm;  ///< second derivative of the distance over the gear's turn there, mm/rad^2, > 0
  /// The mated place of the pinion. Of the plain pinion of a face gear its radius and where it lies along the axis, of
  /// a bevel pinion height and cone distance.
  std::vector<double> pinion_across_mm, pinion_along_mm;
  /// Distance per turn of the pinion, mm; empty: the same everywhere, and turns are counted as distances.
  std::vector<double> lever_mm;
  [[nodiscard]] double lever(std::size_t place) const { return lever_mm.empty() ? 1 : lever_mm[place]; }
};

struct EaseOff {
  std::vector<EaseOffMap> maps;  ///< one a member
  /// What was taken off all distances: with the turn at which the flanks first touch, the distance there. mm
  double shift_mm = 0;
  double shift = 0;  ///< the same as a turn of the pinion, rad; where the maps have no levers as the distance
  /// A place of one of the maps.
  struct Place {
    std::size_t member = 0, index = 0;
    double gap_mm = 0;
  };
  Place least, greatest;
  std::size_t places = 0;  ///< that have a common normal, in all maps
};

/// Turns the pinions of all maps of a side together to where the first place touches. Refused: no place with a common
/// normal. @param maps  distances at the exact ratio
[[nodiscard]] Result<EaseOff> brought_to_touch(std::vector<EaseOffMap> maps);

/// Of members of one side of one gear. Error: below 1e-9 mm, and the square of the flanks' slopes against each other
/// times the gap: 1e-4 of it on usual reliefs. Refused: no place with a common normal.
[[nodiscard]] Result<EaseOff> ease_off(const std::vector<ContactMember>& members);

}  // namespace toothpath::contact
