#include "geometry/cylindrical/span.h"

#include <algorithm>
#include <cmath>

namespace toothpath::cylindrical {

Span span_over(const InvoluteKernel<double>& gear, int teeth) {
  Span out;
  out.teeth = teeth;
  out.length_mm = gear.r_b * gear.cos_bb * (kTwoPi * teeth / gear.teeth - 2 * gear.eta_b);
  out.touch_radius_mm = std::hypot(gear.r_b, 0.5 * out.length_mm * gear.cos_bb);
  out.least_face_mm = out.length_mm * std::abs(gear.sin_bb);
  return out;
}

Span usual_span(const InvoluteKernel<double>& gear) {
  const double form = gear.r_b * std::hypot(1, gear.theta_f), middle = 0.5 * (form + gear.r_a),
               wanted = 2 * gear.r_b * gear.theta_at(middle) / gear.cos_bb;
  const double count = (wanted / (gear.r_b * gear.cos_bb) + 2 * gear.eta_b) * gear.teeth / kTwoPi;
  return span_over(gear, std::max(1, int(std::lround(count))));
}

}  // namespace toothpath::cylindrical
