#include "cam/tool/frustum_distance.h"

#include <algorithm>
#include <cmath>

namespace toothpath::tool {
namespace {

/// Signed distance in the half plane through the axis, and its gradient there.
struct HalfPlane {
  double distance = 0, d_rho = 0, d_h = 0;
};
inline HalfPlane half_plane(double rho, double h, const Frustum& f) {
  const double below = f.from - h, above = h - f.to;
  if (below > 0 && rho <= f.radius_from) return {below, 0, -1};
  if (above > 0 && rho <= f.radius_to) return {above, 0, 1};
  const double dr = f.radius_to - f.radius_from, dh = f.to - f.from;
  const double side = (rho - f.radius_from) * dh - (h - f.from) * dr;  // times the length of the generator
  const auto inside = [&]() -> HalfPlane {
    const double slant = std::sqrt(dr * dr + dh * dh);
    if (side >= below * slant && side >= above * slant) return {side / slant, dh / slant, -dr / slant};
    return below >= above ? HalfPlane{below, 0, -1} : HalfPlane{above, 0, 1};
  };
  if (side <= 0 && below <= 0 && above <= 0) return inside();
  double best = INFINITY, best_x = 0, best_y = 0;
  const auto segment = [&](double r0, double h0, double er, double eh) {
    const double l2 = er * er + eh * eh;
    const double t = l2 > 0 ? std::clamp(((rho - r0) * er + (h - h0) * eh) / l2, 0.0, 1.0) : 0.0;
    const double x = rho - r0 - t * er, y = h - h0 - t * eh, d2 = x * x + y * y;
    if (d2 >= best) return;
    best = d2;
    best_x = x;
    best_y = y;
  };
  if (below > 0) segment(0, f.from, f.radius_from, 0);
  segment(f.radius_from, f.from, dr, dh);
  if (above > 0) segment(0, f.to, f.radius_to, 0);
  const double d = std::sqrt(best);
  return d > 0 ? HalfPlane{d, best_x / d, best_y / d} : inside();  // on the boundary, but for rounding
}

}  // namespace

double frustum_distance(const Vec3& x, const Frustum& f) {
  return half_plane(std::sqrt(x.x() * x.x() + x.y() * x.y()), x.z(), f).distance;
}

FrustumSlope frustum_slope(const Vec3& x, const Frustum& f) {
  const double rho = std::sqrt(x.x() * x.x() + x.y() * x.y());
  const auto q = half_plane(rho, x.z(), f);
  const Vec3 radial = rho > 1e-12 ? Vec3(x.x() / rho, x.y() / rho, 0) : Vec3(0, 0, 0);
  return {q.distance, Vec3(q.d_rho * radial + Vec3(0, 0, q.d_h))};
}

PlacedFrustum::PlacedFrustum(const Frustum& body, const Vec3& tip, const Vec3& axis)
    : body_(body), tip_(tip), axis_(axis), widest_(std::max(body.radius_from, body.radius_to)) {}

double PlacedFrustum::distance(const Vec3& point) const {
  const Vec3 d = point - tip_;
  const double h = d.dot(axis_);
  return half_plane((d - h * axis_).norm(), h, body_).distance;
}

FrustumSlope PlacedFrustum::slope(const Vec3& point) const {
  const Vec3 d = point - tip_;
  const double h = d.dot(axis_);
  const Vec3 across = d - h * axis_;
  const double rho = across.norm();
  const auto q = half_plane(rho, h, body_);
  const Vec3 radial = rho > 1e-12 ? Vec3(across / rho) : Vec3(0, 0, 0);
  return {q.distance, Vec3(q.d_rho * radial + q.d_h * axis_)};
}

}  // namespace toothpath::tool
