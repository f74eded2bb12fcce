// How deep a flank is along the tooth: from its tip to its fillet line.
#pragma once

#include <optional>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// Straight between its middle and both ends: of teeth that taper towards the apex of a cone it is.
struct FlankDepth {
  double middle_mm = 0;  ///< of h, in the middle of the ring
  double s_middle = 0;
  double growth = 0;  ///< share of `middle_mm` per mm of s
  /// How much deeper than in the middle.
  template <typename S>
  [[nodiscard]] S share(const S& s) const {
    return growth == 0 ? S(1) : S(S(1) + S(growth) * (s - S(s_middle)));
  }
};

/// Nothing where the fillet line is not found or does not lie below the tips.
[[nodiscard]] std::optional<FlankDepth> flank_depth(const ToothSpace& space, int side);

}  // namespace toothpath::tooth_space
