#include "tests/support/brute_force_face_gear.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace toothpath::test {

using std::numbers::pi;

BruteForceFaceGear::BruteForceFaceGear(const face_gear::FaceGearParameters& gear, double beta) {
  shaper_teeth_ = gear.shaper_teeth;
  ratio_ = double(gear.shaper_teeth) / gear.teeth;
  offset_ = gear.offset_mm;
  sin_gamma_ = std::sin(gear.shaft_angle_rad);
  cos_gamma_ = std::cos(gear.shaft_angle_rad);
  const bool normal = gear.module_plane == face_gear::ModulePlane::normal;
  const double m_t = normal ? gear.module_mm / std::cos(beta) : gear.module_mm;
  const double alpha_t =
      normal ? std::atan2(std::tan(gear.pressure_angle_rad), std::cos(beta)) : gear.pressure_angle_rad;
  const double r_p = 0.5 * m_t * gear.shaper_teeth;
  r_b_ = r_p * std::cos(alpha_t);
  r_a_ = r_p + (gear.addendum_coefficient + gear.clearance_coefficient) * gear.module_mm;
  rho_ = gear.shaper_tip_radius_mm;
  twist_ = std::tan(beta) / r_p;
  cos_base_helix_ = 1 / std::hypot(1.0, std::tan(beta) * std::cos(alpha_t));
  // Half of the tooth space on the pitch circle is a quarter pitch; on the base circle it is less by inv(alpha_t).
  half_space_ =
      pi / (2 * shaper_teeth_) - (std::tan(alpha_t) - alpha_t) - gear.backlash_mm / (2 * r_b_ * cos_base_helix_);
  reference_ = gear.reference_radius_mm ? *gear.reference_radius_mm : r_p * (1 / ratio_ + cos_gamma_) / sin_gamma_;
  // The rounding's centre lies rho inside the tip circle and rho behind the involute.
  centre_radius_ = r_a_ - rho_;
  const double length = std::sqrt(centre_radius_ * centre_radius_ - r_b_ * r_b_) + rho_;
  const double pressure = std::acos(r_b_ / centre_radius_);
  centre_angle_ = half_space_ + length / r_b_ - pressure;
  rounding_opening_ = pi / 2 - pressure;  // from the radial normal at the tip circle to the involute's normal
}

double BruteForceFaceGear::clearance(const Vec3& point, double phi) const {
  const double turn = ratio_ * phi, c = std::cos(turn), s = std::sin(turn);
  const double hx = c * point.x() - s * point.y(), hy = s * point.x() + c * point.y(), hz = point.z();
  const double along = sin_gamma_ * hx - cos_gamma_ * hz;
  const double x = -cos_gamma_ * hx - sin_gamma_ * hz, y = hy - offset_;
  const double R = std::hypot(x, y);
  if (along <= 0) return R + r_a_;  // behind the gear axis: not the cutting side
  const double w =
      std::abs(std::remainder(std::atan2(y, x) - phi - twist_ * (along - reference_), 2 * pi / shaper_teeth_));
  const double to_tip = R - r_a_;
  if (R <= r_b_) return std::max(r_b_ * (half_space_ - w), to_tip);
  if (rho_ > 0) {
    const double u = R * std::cos(w - centre_angle_) - centre_radius_, v = R * std::sin(w - centre_angle_);
    const double direction = std::atan2(-v, u);
    if (direction >= 0 && direction <= rounding_opening_) return std::hypot(u, v) - rho_;
  }
  const double to_involute = std::sqrt(R * R - r_b_ * r_b_) - r_b_ * (w + std::acos(r_b_ / R) - half_space_);
  return std::max(to_involute, to_tip);
}

double BruteForceFaceGear::least_clearance(const Vec3& point, double enough) const {
  const double r = std::hypot(point.x(), point.y()), azimuth = std::atan2(point.y(), point.x());
  // All phi at which the point can be within the tip cylinder: |y| <= r_a, and one step more on both sides.
  const double low = std::asin(std::clamp((offset_ - r_a_) / r, -1.0, 1.0));
  const double high = std::asin(std::clamp((offset_ + r_a_) / r, -1.0, 1.0));
  const double step = 2 * pi / shaper_teeth_ / 48;
  const double start = (low - azimuth) / ratio_ - step;
  const int count = int(std::ceil((high - low) / ratio_ / step)) + 3;
  std::vector<double> sampled(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double f = sampled[std::size_t(k)] = clearance(point, start + k * step);
    if (f <= enough) return f;
  }
  std::vector<std::pair<double, int>> minima;
  for (int k = 1; k + 1 < count; ++k) {
    const double f = sampled[std::size_t(k)];
    if (f <= sampled[std::size_t(k - 1)] && f <= sampled[std::size_t(k + 1)]) minima.emplace_back(f, k);
  }
  std::sort(minima.begin(), minima.end());
  double least = *std::min_element(sampled.begin(), sampled.end());
  const double golden = (std::sqrt(5.0) - 1) / 2;
  for (std::size_t n = 0; n < std::min<std::size_t>(minima.size(), 4); ++n) {
    double a = start + (minima[n].second - 1) * step, b = a + 2 * step;
    double p = b - golden * (b - a), q = a + golden * (b - a);
    double fp = clearance(point, p), fq = clearance(point, q);
    for (int k = 0; k < 55; ++k) {  // no smoothness assumed: the sharp tip edge makes kinks
      if (fp <= fq) {
        b = q;
        q = p;
        fq = fp;
        p = b - golden * (b - a);
        fp = clearance(point, p);
      } else {
        a = p;
        p = q;
        fp = fq;
        q = a + golden * (b - a);
        fq = clearance(point, q);
      }
      least = std::min({least, fp, fq});
    }
  }
  return least;
}

}  // namespace toothpath::test
