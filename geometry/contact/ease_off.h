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

/// One flank; all lists as its grid. NaN: the flanks have no common normal there, the pinion's involute ends before.
struct EaseOffMap {
  std::vector<double> gap_mm;   ///< normal to the flank; the least of all members of a side is 0
  std::vector<double> phi_2;    ///< turn of the gear at which tooth 0 is nearest there, rad
  std::vector<double> bend_mm;  ///< second derivative of the distance over the gear's turn there, mm/rad^2, > 0
  std::vector<double> pinion_radius_mm, pinion_Z_mm;  ///< the mated place of the plain pinion
};

struct EaseOff {
  std::vector<EaseOffMap> maps;  ///< one a member
  /// What was taken off all distances: with the turn at which the flanks first touch, the distance there. mm
  double shift_mm = 0;
  /// A place of one of the maps.
  struct Place {
    std::size_t member = 0, index = 0;
    double gap_mm = 0;
  };
  Place least, greatest;
  std::size_t places = 0;  ///< that have a common normal, in all maps
};

/// Of members of one side of one gear. Error: below 1e-9 mm, and the square of the flanks' slopes against each other
/// times the gap: 1e-4 of it on usual reliefs. Refused: no place with a common normal.
[[nodiscard]] Result<EaseOff> ease_off(const std::vector<ContactMember>& members);

}  // namespace toothpath::contact
