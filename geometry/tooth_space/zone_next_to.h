// The zone of a toothed part that a place along its teeth belongs to.
#pragma once

#include <algorithm>

#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::tooth_space {

/// The zone that holds s, or the one whose end is nearest: in a groove the nearer ring.
[[nodiscard]] inline int zone_next_to(const ToothedPart& part, double s) {
  const auto away = [&](int zone) {
    const Outline& ring = part.space(zone).outline();
    return std::max(ring.s_from - s, s - ring.s_to);
  };
  int nearest = 0;
  for (int zone = 1; zone < part.zones(); ++zone)
    if (away(zone) < away(nearest)) nearest = zone;
  return nearest;
}

}  // namespace toothpath::tooth_space
