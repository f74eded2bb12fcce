// The span over several teeth of a cylindrical gear: the distance of two parallel planes that touch its flanks.
#pragma once

#include "geometry/cylindrical/involute_kernel.h"

namespace toothpath::cylindrical {

/// ISO 21771: base tangent length W_k over k teeth, in the normal section. mm
struct Span {
  int teeth = 0;               ///< k
  double length_mm = 0;        ///< W_k
  double touch_radius_mm = 0;  ///< at which both planes touch, in the middle of the face
  double least_face_mm = 0;    ///< the face must be wider: W_k sin(beta_b)
};
/// W_k = r_b cos(beta_b) (2 pi k/z - 2 eta_b), eta_b the half angle of the space on the base cylinder.
[[nodiscard]] Span span_over(const InvoluteKernel<double>& gear, int teeth);
/// Over as many teeth as touch nearest to the middle of the flank.
[[nodiscard]] Span usual_span(const InvoluteKernel<double>& gear);

}  // namespace toothpath::cylindrical
