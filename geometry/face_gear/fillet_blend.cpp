#include "geometry/face_gear/fillet_blend.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toothpath::face_gear {
namespace {

constexpr int kEntries = 2049;

struct Hermite {
  double v = 0, d = 0;
};
/// Cubic through v0, v1 with the slopes d0, d1 over a unit step.
Hermite hermite(double t, double v0, double d0, double v1, double d1) {
  const double u = 1 - t;
  return {(1 + 2 * t) * u * u * v0 + t * u * u * d0 + t * t * (3 - 2 * t) * v1 - t * t * u * d1,
          6 * t * u * (v1 - v0) + u * (1 - 3 * t) * d0 + t * (3 * t - 2) * d1};
}

}  // namespace

FilletBlend::FilletBlend(const FaceGearSurface<double>& f, const FaceGearSurface<Dual2>& dual,
                         const FlankCorrection& flank, int side, double from_mm, double to_mm)
    : A_t_(f.shaper.A_t),
      A_span_(f.shaper.A_e - f.shaper.A_t),
      from_(from_mm),
      step_((to_mm - from_mm) / (kEntries - 1)) {
  const double theta_t = f.shaper.theta_t;
  const auto entry = [&](double Z) -> std::optional<Entry> {
    const auto g = dual.fillet(side, Dual2::variable(A_t_, 0), Dual2::variable(Z, 1));
    if (!g.defined) return {};
    const double B = g.B.v;
    if (!(std::abs(B) < 1.4) || !(f.flank_J(side, theta_t, B) > 0)) return {};
    const Vec3 p = value(g.p), p_A = derivative(g.p, 0), p_Z = derivative(g.p, 1);
    const double r = std::hypot(p.x(), p.y());
    const auto c = flank.at(theta_t, r);
    // Normal of the displaced flank there; the slope is the one that gives the displaced fillet the same normal.
    const auto k = dual.flank(side, Dual2::variable(theta_t, 0), Dual2::variable(B, 1));
    const auto along_r = [&](const Vec3& x) { return (p.x() * x.x() + p.y() * x.y()) / r; };
    const Vec3 p_u = derivative(k.p, 0), p_v = derivative(k.p, 1), n = value(k.n);
    const double c_u = c.d_theta + c.d_radius * along_r(p_u), c_v = c.d_radius * along_r(p_v);
    const Vec3 normal =
        (p_u + c_u * n + c.value * derivative(k.n, 0)).cross(p_v + c_v * n + c.value * derivative(k.n, 1));
    const double lean = normal.dot(n);
    if (lean == 0) return {};
    const double c_A = -normal.dot(p_A + c.value * derivative(g.n, 0)) / lean;
    return Entry{c.value, A_span_ * c_A, step_ * c.d_radius * along_r(p_Z), 0};
  };
  std::vector<std::optional<Entry>> found;
  for (int k = 0; k < kEntries; ++k) found.push_back(entry(from_ + step_ * k));
  const auto first = std::find_if(found.begin(), found.end(), [](const auto& e) { return e.has_value(); });
  Entry last = first == found.end() ? Entry{} : **first;
  last.d_value = 0;
  for (const auto& e : found) {
    table_.push_back(e.value_or(last));
    if (e) last = *e;
    last.d_value = 0;
  }
  for (std::size_t k = 0; k < table_.size(); ++k) {
    const auto &a = table_[k > 0 ? k - 1 : k], &b = table_[std::min(k + 1, table_.size() - 1)];
    table_[k].d_slope = 0.5 * (b.slope - a.slope);
  }
}

FilletBlend::Offset FilletBlend::at(double A, double Z) const {
  const double place = std::clamp((Z - from_) / step_, 0.0, double(kEntries - 1));
  const auto k = std::min(std::size_t(place), table_.size() - 2);
  const bool outside = Z < from_ || Z > from_ + step_ * (kEntries - 1);
  const auto &a = table_[k], &b = table_[k + 1];
  const double y = place - double(k);
  Hermite c = hermite(y, a.value, a.d_value, b.value, b.d_value),
          m = hermite(y, a.slope, a.d_slope, b.slope, b.d_slope);
  if (outside) c.d = m.d = 0;
  // Before A_t and beyond A_e Newton may look: the flank's tangent, and nothing.
  const double t = (A - A_t_) / A_span_;
  if (t >= 1) return {};
  if (t <= 0) return {c.v + t * m.v, m.v / A_span_, (c.d + t * m.d) / step_};
  const Hermite from_value = hermite(t, 1, 0, 0, 0), from_slope = hermite(t, 0, 1, 0, 0);
  return {c.v * from_value.v + m.v * from_slope.v, (c.v * from_value.d + m.v * from_slope.d) / A_span_,
          (c.d * from_value.v + m.d * from_slope.v) / step_};
}

}  // namespace toothpath::face_gear
