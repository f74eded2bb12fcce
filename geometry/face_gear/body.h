// The body of a face gear below its teeth, as a drawing has it.
#pragma once

#include <optional>

namespace toothpath::face_gear {

/// mm; 0: not said.
struct Body {
  double thickness_mm = 0;  ///< from the highest tip to the back; 0: 2.5 modules below the lowest of teeth and groove
  /// Diameter, 0: no bore. Narrower than the teeth, a web half a module below the lowest of teeth and groove reaches in
  /// to it. Nothing: the ring of teeth is open inside, and there is no web.
  std::optional<double> bore_mm;
  double hub_mm = 0, hub_length_mm = 0;  ///< diameter and length of the hub behind the back
};

}  // namespace toothpath::face_gear
