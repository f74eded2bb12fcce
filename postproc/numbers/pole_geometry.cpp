#include "postproc/numbers/pole_geometry.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::numbers {

double angle_between_axes(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

Vec3 blend_axes(const Vec3& a, const Vec3& b, double t) {
  const double angle = angle_between_axes(a, b);
  if (angle < 1e-9) return ((1 - t) * a + t * b).normalized();
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

double PoleFrame::phi(const Vec3& u) const { return std::atan2(u.dot(e2), u.dot(e1)); }

Vec3 PoleFrame::axis(double theta, double phi) const {
  return (std::cos(theta) * pole + std::sin(theta) * (std::cos(phi) * e1 + std::sin(phi) * e2)).normalized();
}

PoleArc pole_arc(const PoleFrame& f, const Vec3& u, const Vec3& v) {
  PoleArc a;
  const double tu = f.theta(u), tv = f.theta(v);
  a.turn = angle_between_axes(u, v);
  a.least = std::min(tu, tv);
  a.at = tu <= tv ? 0 : 1;
  if (tu > kNoAzimuth && tv > kNoAzimuth) a.azimuth = std::remainder(f.phi(v) - f.phi(u), 2 * kPi);
  const Vec3 cross = u.cross(v);
  if (cross.norm() < 1e-15) return a;
  const Vec3 n = cross.normalized();
  const Vec3 q = f.pole - f.pole.dot(n) * n;
  if (q.norm() < 1e-6 || u.cross(q).dot(n) < 0 || q.cross(v).dot(n) < 0) return a;
  a.least = std::atan2(std::abs(f.pole.dot(n)), q.norm());
  a.at = std::clamp(angle_between_axes(u, q.normalized()) / a.turn, 0.0, 1.0);
  return a;
}

}  // namespace toothpath::numbers
