#include "geometry/face_gear/shaper.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <cstdint>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::face_gear {
namespace {

FaceGearParameters with_tip_radius(FaceGearParameters gear, double rho_mm) {
  gear.shaper_tip_radius_mm = rho_mm;
  return gear;
}

/// Root of `f` in [lo, hi], f(lo) and f(hi) of opposite sign; to the last bits.
template <typename F>
double bracketed_root(F f, double lo, double hi) {
  const auto converged = [](double x, double y) {
    return std::abs(x - y) <= 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(x), std::abs(y));
  };
  std::uintmax_t steps = 200;
  const auto bracket = boost::math::tools::toms748_solve(f, lo, hi, converged, steps);
  return 0.5 * (bracket.first + bracket.second);
}

/// psi_c - pi/N_s: <= 0 while the rounding fits on the tooth. Grows with rho: d psi_c/d rho = (1 - q/r_c)/r_b.
double tip_excess(const FaceGearParameters& gear, double helix_angle_rad, double rho_mm) {
  const auto w = make_shaper<double>(with_tip_radius(gear, rho_mm), helix_angle_rad);
  return w.psi_c - kPi / gear.shaper_teeth;
}

/// The rounding whose centre lies on the base circle, where the involute would shrink to r_b: r_c = r_b.
double rounding_to_base_circle(const FaceGearParameters& gear, double helix_angle_rad) {
  const auto w = make_shaper<double>(with_tip_radius(gear, 0), helix_angle_rad);
  return (w.r_a - w.r_b) * (1 - 1e-12);
}

}  // namespace

double largest_tip_radius(const FaceGearParameters& gear, double helix_angle_rad) {
  if (tip_excess(gear, helix_angle_rad, 0) >= 0) return 0;
  const double to_base = rounding_to_base_circle(gear, helix_angle_rad);
  if (tip_excess(gear, helix_angle_rad, to_base) <= 0) return to_base;
  return bracketed_root([&](double rho) { return tip_excess(gear, helix_angle_rad, rho); }, 0.0, to_base);
}

double active_roll_parameter(const FaceGearParameters& gear, double helix_angle_rad) {
  const auto w = make_shaper<double>(with_tip_radius(gear, 0), helix_angle_rad);
  const double r_tip = w.r_p + w.h_a;
  return std::sqrt(r_tip * r_tip - w.r_b * w.r_b) / w.r_b;
}

double largest_active_tip_radius(const FaceGearParameters& gear, double helix_angle_rad) {
  const double largest = largest_tip_radius(gear, helix_angle_rad);
  const double theta_act = active_roll_parameter(gear, helix_angle_rad);
  const auto spare = [&](double rho) {
    return make_shaper<double>(with_tip_radius(gear, rho), helix_angle_rad).theta_t - theta_act;
  };
  if (spare(largest) >= 0) return largest;
  if (spare(0) <= 0) return 0;
  return bracketed_root(spare, 0.0, largest);
}

Status check_shaper(const FaceGearParameters& gear, double helix_angle_rad) {
  const auto sharp = make_shaper<double>(with_tip_radius(gear, 0), helix_angle_rad);
  const double half_pitch = kPi / gear.shaper_teeth;
  if (sharp.psi_c > half_pitch)
    return fail(
        "the shaper's teeth are pointed: half space angle {:.6f} deg at the tip radius {:.4f} mm exceeds the half "
        "pitch {:.6f} deg",
        degrees(sharp.psi_c), sharp.r_a, degrees(half_pitch));
  if (sharp.psi_c <= 0)
    return fail(
        "the shaper has no tooth spaces at its tip: half space angle {:.6f} deg at the tip radius {:.4f} mm, limit 0 "
        "(backlash {:.4f} mm is too large)",
        degrees(sharp.psi_c), sharp.r_a, gear.backlash_mm);
  if (gear.shaper_tip_radius_mm < 0)
    return fail("shaper tip rounding {:.4f} mm is negative, limit 0", gear.shaper_tip_radius_mm);
  const double largest = largest_tip_radius(gear, helix_angle_rad);
  if (gear.shaper_tip_radius_mm > largest * (1 + 1e-12))
    return fail("shaper tip rounding {:.4f} mm is too large: the full round tip has {:.4f} mm",
                gear.shaper_tip_radius_mm, largest);
  return Ok{};
}

}  // namespace toothpath::face_gear
