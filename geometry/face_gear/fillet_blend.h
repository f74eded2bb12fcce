// How a displaced flank runs into its fillet: the offset at the fillet line, value and slope, fades to nothing at the
// root land.
#pragma once

#include "geometry/base/dual.h"
#include "geometry/face_gear/flank_field.h"
#include "geometry/modification/smooth_curve.h"

namespace toothpath::face_gear {

/// Offset of the fillet of one side, mm along its normal, over the fillet's parameters (A, Z): a cubic in A with value
/// and slope of the flank's field at A_t and zero value and slope at A_e, so that flank, fillet and root stay one
/// smooth sheet.
class FilletBlend {
 public:
  using Dual2 = Dual<double, 2>;
  /// Sections Z in [from_mm, to_mm] are tabulated; where no regular fillet line exists the nearest values hold.
  FilletBlend(const FaceGearSurface<double>& surface, const FaceGearSurface<Dual2>& dual, const FlankField& flank,
              int side, double from_mm, double to_mm);

  /// In any scalar of the kernels. Before A_t along the tangent, beyond A_e nothing.
  template <typename S>
  [[nodiscard]] S at(const S& A, const S& Z) const {
    const S t = (A - S(A_t_)) / S(A_span_);
    return value_(Z) * fades_(t) + slope_(Z) * swings_(t);
  }

 private:
  double A_t_ = 0, A_span_ = 1;
  modification::SmoothCurve value_, slope_;   ///< at the fillet line over Z: offset, and its derivative with t
  modification::SmoothCurve fades_, swings_;  ///< cubics in t that carry value and slope from 0 to 1
};

}  // namespace toothpath::face_gear
