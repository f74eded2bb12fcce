// What modifications take off the walls of a bevel gear, in the two ways that a finger mill has: its profile grows over
// the depth, its path moves towards the wall along the face. mm. Derivation: docs/modifications.md, section 6.
#pragma once

#include <vector>

#include "geometry/modification/smooth_curve.h"

namespace toothpath::bevel_gear {

/// Sum of functions of one number.
struct CurveSum {
  std::vector<modification::SmoothCurve> curves;

  /// The derivative of this order, 0 the value.
  template <typename S>
  [[nodiscard]] S derivative(const S& x, std::size_t order) const {
    S sum(0);
    for (const auto& curve : curves) sum = sum + curve.derivative(x, order);
    return sum;
  }
};

/// Of all walls alike: they have one mill.
struct ProfileLaw {
  CurveSum removed;    ///< along the normal of the plain profile, over the depth below `tip_mm`
  double tip_mm = 0;   ///< height of the tip above the pitch cone, along the axis of the mill
  double bent_to = 0;  ///< depth below which it goes on straight
};

/// Of one wall of one half.
struct LeadLaw {
  CurveSum removed;       ///< over the cone distance of the tooth trace, along the normal of the wall at the pitch cone
  double per_normal = 1;  ///< way of the mill along the pitch cone, square to the trace, per mm of it
};

}  // namespace toothpath::bevel_gear
