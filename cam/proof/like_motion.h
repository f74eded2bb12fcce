// Motions that go nearly as others do, on another tooth: what is proven of those holds for these, but for the way
// between them.
#pragma once

#include <cstdint>

namespace toothpath::proof {

/// A motion of a list, and those of the same list and operation that it is like, turned about the gear axis by whole
/// teeth.
struct LikeMotion {
  std::uint32_t motion = 0;
  std::uint32_t like_first = 0, like_last = 0;  ///< motions [like_first, like_last)
  float tip_mm = 0;                             ///< no tip that the motion may take is farther than this, and
  float axis_rad = 0;  ///< no axis turned farther than this, from what the others may take at some moment
  /// How far a point of the tool `arm_mm` from the tip may be from where the others may have it.
  [[nodiscard]] double away(double arm_mm) const { return double(tip_mm) + arm_mm * double(axis_rad); }
};

}  // namespace toothpath::proof
