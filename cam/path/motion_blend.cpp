#include "cam/path/motion_blend.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::path {

double line_slack(const ToolMotion& m, double arm_mm, double dt) {
  // The axis is b / |b| with b linear: with T = 2 tan(half the turn), its second derivative is at most T^2 sqrt(1 +
  // T^2).
  const double half = std::min(0.5 * (m.axis_to - m.axis_from).norm(), 0.9999);
  const double T = 2 * half / std::sqrt(1 - half * half);
  return m.deviation_mm + arm_mm * (m.axis_deviation + T * T * std::sqrt(1 + T * T) * dt * dt / 8);
}

int pieces_about_axis(const Vec3& from, const Vec3& to, double dip_mm) {
  const double turn = std::abs(angle_from_to(from, to)), r = std::max(radius(from), radius(to));
  return std::max(1, int(std::ceil(turn / std::sqrt(8 * dip_mm / r))));
}

}  // namespace toothpath::path
