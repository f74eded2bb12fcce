// A gear of one ring of teeth, as planners and proofs ask for it: all of it follows from its space and a few numbers.
#pragma once

#include <memory>

#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::tooth_space {

/// mm; the root is h of the chart.
struct RingNumbers {
  int teeth = 0;
  double module_mm = 0, lowest_root = 0, bore_mm = 0;
};

/// The blank is turned: the tip surface between both ends of the ring, down to the bore.
[[nodiscard]] std::shared_ptr<const ToothedPart> ring_part(std::shared_ptr<const ToothSpace> space,
                                                           const RingNumbers& numbers);

}  // namespace toothpath::tooth_space
