#include "geometry/face_gear/swept_solid.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/base/golden_section.h"

namespace toothpath::face_gear {
namespace {

constexpr int kSamplesPerTooth = 48;
constexpr int kMinimaRefined = 4;
constexpr int kGoldenSteps = 75;  // 0.618^75 of two samples: below rounding

/// The shaper's solid section, seen from one point of the gear while both turn.
class ShaperPassing {
 public:
  ShaperPassing(const FaceGearSurface<double>& surface, const Vec3& point)
      : f_(surface), w_(surface.shaper), point_(point) {}

  /// Transverse distance to the shaper at roll angle phi, positive outside it.
  [[nodiscard]] double operator()(double phi) const {
    const Vec3 p = turned(point_, f_.i * phi);
    const double Z = p.dot(f_.a()), x = p.dot(f_.d()), y = p.y() - f_.E, R = std::hypot(x, y);
    if (Z <= 0) return R + w_.r_a;  // behind the gear axis: not the cutting side
    const double pitch = 2 * kPi / w_.teeth;
    const double psi = std::abs(std::remainder(std::atan2(y, x) - phi - w_.kappa * (Z - f_.L0), pitch));
    const double to_tip = R - w_.r_a;
    if (R <= w_.r_b) return std::max(w_.r_b * (w_.theta_0 - psi), to_tip);
    if (w_.rho > 0) {
      // Seen from the centre of the rounding: on its arc between the radial direction and the end of the involute?
      const double u = R * std::cos(psi - w_.psi_c) - w_.r_c, v = R * std::sin(psi - w_.psi_c);
      const double direction = std::atan2(-v, u);
      if (direction >= 0 && direction <= w_.A_e - w_.A_t) return std::hypot(u, v) - w_.rho;
    }
    const double to_involute = std::sqrt(R * R - w_.r_b * w_.r_b) - w_.r_b * (psi + std::acos(w_.r_b / R) - w_.theta_0);
    return std::max(to_involute, to_tip);
  }

 private:
  const FaceGearSurface<double>& f_;
  const InvoluteShaper<double>& w_;
  Vec3 point_;
};

/// Least value between a and b, where one minimum is expected; no smoothness needed.
double golden_minimum(const ShaperPassing& distance, double a, double b) {
  auto search = golden_section<std::less_equal<>>(a, b, std::cref(distance));
  double least = search.best().second;
  for (int k = 0; k < kGoldenSteps; ++k) {
    search.step();
    least = std::min(least, search.best().second);
  }
  return least;
}

}  // namespace

double swept_clearance(const FaceGearSurface<double>& f, const Vec3& point) {
  const ShaperPassing distance(f, point);
  const double r = std::hypot(point.x(), point.y()), azimuth = std::atan2(point.y(), point.x());
  // Every phi at which the point can lie within the tip cylinder, and a step more at both ends.
  const double low = std::asin(std::clamp((f.E - f.shaper.r_a) / r, -1.0, 1.0));
  const double high = std::asin(std::clamp((f.E + f.shaper.r_a) / r, -1.0, 1.0));
  const double step = 2 * kPi / f.shaper.teeth / kSamplesPerTooth, start = (low - azimuth) / f.i - step;
  const auto count = std::size_t(std::ceil((high - low) / f.i / step)) + 3;
  std::vector<double> sampled(count);
  for (std::size_t k = 0; k < count; ++k) sampled[k] = distance(start + double(k) * step);
  std::vector<std::size_t> minima;
  for (std::size_t k = 1; k + 1 < count; ++k)
    if (sampled[k] <= sampled[k - 1] && sampled[k] <= sampled[k + 1]) minima.push_back(k);
  std::sort(minima.begin(), minima.end(), [&](std::size_t a, std::size_t b) { return sampled[a] < sampled[b]; });
  double least = *std::min_element(sampled.begin(), sampled.end());
  for (std::size_t n = 0; n < std::min<std::size_t>(minima.size(), kMinimaRefined); ++n)
    least = std::min(least, golden_minimum(distance, start + (double(minima[n]) - 1) * step,
                                           start + (double(minima[n]) + 1) * step));
  return least * f.shaper.cos_bb;
}

}  // namespace toothpath::face_gear
