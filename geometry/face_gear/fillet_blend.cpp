#include "geometry/face_gear/fillet_blend.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toothpath::face_gear {
namespace {

using modification::SmoothCurve;

constexpr std::size_t kEntries = 2049;

struct Entry {
  double value = 0, slope = 0;      ///< offset and its derivative with the fraction of A at the fillet line
  double d_value = 0, d_slope = 0;  ///< by Z
};

std::vector<double> all(const std::vector<Entry>& table, double Entry::*number) {
  std::vector<double> out;
  for (const Entry& e : table) out.push_back(e.*number);
  return out;
}

}  // namespace

FilletBlend::FilletBlend(const FaceGearSurface<double>& f, const FaceGearSurface<Dual2>& dual, const FlankField& flank,
                         int side, double from_mm, double to_mm)
    : A_t_(f.shaper.A_t),
      A_span_(f.shaper.A_e - f.shaper.A_t),
      fades_({0, 1}, {{0, {1, 0, -3, 2}}}),
      swings_({0, 1}, {{0, {0, 1, -2, 1}}}) {
  const double theta_t = f.shaper.theta_t, step = (to_mm - from_mm) / double(kEntries - 1);
  const auto entry = [&](double Z) -> std::optional<Entry> {
    const auto g = dual.fillet(side, Dual2::variable(A_t_, 0), Dual2::variable(Z, 1));
    if (!g.defined) return {};
    const double B = g.B.v;
    if (!(std::abs(B) < 1.4) || !(f.flank_J(side, theta_t, B) > 0)) return {};
    // Normal of the displaced flank there; the slope is the one that gives the displaced fillet the same normal.
    const Dual2 theta = Dual2::variable(theta_t, 0);
    const auto k = dual.flank(side, theta, Dual2::variable(B, 1));
    const Dual2 c = flank.offset(dual, theta, k.p), along = flank.offset(dual, Dual2(theta_t), g.p);
    const Vec3 n = value(k.n);
    const Vec3 normal = (derivative(k.p, 0) + c.d[0] * n + c.v * derivative(k.n, 0))
                            .cross(derivative(k.p, 1) + c.d[1] * n + c.v * derivative(k.n, 1));
    const double lean = normal.dot(n);
    if (lean == 0) return {};
    const double c_A = -normal.dot(derivative(g.p, 0) + c.v * derivative(g.n, 0)) / lean;
    return Entry{c.v, A_span_ * c_A, along.d[1], 0};
  };
  std::vector<std::optional<Entry>> found;
  for (std::size_t k = 0; k < kEntries; ++k) found.push_back(entry(from_mm + step * double(k)));
  const auto first = std::find_if(found.begin(), found.end(), [](const auto& e) { return e.has_value(); });
  Entry last = first == found.end() ? Entry{} : **first;
  last.d_value = 0;
  std::vector<Entry> table;
  for (const auto& e : found) {
    table.push_back(e.value_or(last));
    if (e) last = *e;
    last.d_value = 0;
  }
  for (std::size_t k = 0; k < kEntries; ++k) {
    const auto &a = table[k > 0 ? k - 1 : k], &b = table[std::min(k + 1, kEntries - 1)];
    table[k].d_slope = 0.5 * (b.slope - a.slope) / step;
  }
  std::vector<double> places;
  for (std::size_t k = 0; k < kEntries; ++k) places.push_back(from_mm + step * double(k));
  value_ = SmoothCurve::hermite(places, all(table, &Entry::value), all(table, &Entry::d_value));
  slope_ = SmoothCurve::hermite(std::move(places), all(table, &Entry::slope), all(table, &Entry::d_slope));
}

}  // namespace toothpath::face_gear
