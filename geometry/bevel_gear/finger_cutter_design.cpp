#include "geometry/bevel_gear/finger_cutter_design.h"

#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/bevel_gear/limits.h"
#include "geometry/bevel_gear/modified_walls.h"

namespace toothpath::bevel_gear {
namespace {

constexpr double kWidestShare = 0.99, kNarrowestShare = 0.97;  ///< of m_n(R_i)
constexpr double kTipRadiusShare = 0.8;                        ///< of the largest tip radius
constexpr double kHeightShare = 1.10;                          ///< x_D / h_a, rounded up

/// Largest multiple of the coarsest step that lies in [low, high]; the middle where no step does.
double round_into(double low, double high) {
  for (const double step : {0.25, 0.1, 0.05, 0.02, 0.01, 0.005, 0.001, 1e-4}) {
    const double value = std::floor(high / step + 1e-9) * step;
    if (value >= low && value > 0) return std::round(value * 1e6) / 1e6;
  }
  return 0.5 * (low + high);
}

}  // namespace

FingerCutterData finger_cutter_for(const BevelGearParameters& p) {
  const double delta = bevel_pitch_angle(p), sd = std::sin(delta);
  const double R_e = p.teeth * p.outer_transverse_module_mm / (2 * sd), R_i = R_e - p.face_width_mm;
  const double R_0 = R_e / std::pow(std::cos(p.outer_spiral_angle_rad), 2);
  const double kappa_v = std::abs(delta - kPi / 2) < 1e-15 ? 0.0 : std::cos(delta) / (R_0 * sd);
  // Beyond the apex there is no small end; the gear is refused for that, not for its cutter.
  const double m_i = R_i > 0 ? 2 * sd / p.teeth * R_i * std::sqrt(R_i / R_0) : 0.5 * p.outer_transverse_module_mm;
  FingerCutterData c;
  c.module_mm = round_into(kNarrowestShare * m_i, kWidestShare * m_i);
  c.rack_depth_mm = p.addendum_mm;
  c.profile_height_mm = round_into(kHeightShare * p.addendum_mm, 1.15 * p.addendum_mm);
  const auto bare = make_finger_profile<double>(
      {p.pressure_angle_rad, kappa_v, p.dedendum_mm, c.module_mm, 0.0, c.rack_depth_mm, c.profile_height_mm},
      profile_law(p));
  const double largest = largest_tip_radius(bare);
  c.tip_radius_mm = largest > 0 ? round_into(0.9 * kTipRadiusShare * largest, kTipRadiusShare * largest)
                                : 1e-3 * p.outer_transverse_module_mm;
  return c;
}

Expected<FingerCutterDesign, std::vector<Refusal>> design_finger_cutter(const BevelGearParameters& parameters) {
  const FingerCutterData data = finger_cutter_for(parameters);
  auto made = BevelGear::make(parameters, data);
  if (auto* refusals = made.refused()) return std::move(*refusals);
  return FingerCutterDesign{data, std::move(made).value()};
}

std::vector<ProfileSample> sample_profile(const FingerProfile<double>& c, double chord_mm) {
  std::vector<ProfileSample> samples;
  const auto add = [&](char part, double p, const ProfilePoint<double>& q, double curvature) {
    samples.push_back({part, p, q.x + c.h_f, q.x, q.rho, std::atan2(q.sin_psi, q.cos_psi), curvature});
  };
  samples.push_back({'F', c.p_A, 0, -c.h_f, 0, kPi / 2, 0});
  samples.push_back({'F', c.p_A, 0, -c.h_f, c.rho_o, kPi / 2, 0});
  // A chord over the angle t departs by r (1 - cos(t/2)).
  const double turn = kPi / 2 - c.phi;
  const double widest = 2 * std::acos(std::clamp(1 - chord_mm / c.r_t, -1.0, 1.0));
  const int arcs = std::max(1, static_cast<int>(std::ceil(turn / widest)));
  for (int k = 0; k <= arcs; ++k) {
    const double p = k == arcs ? c.p_B : c.p_A + (c.p_B - c.p_A) * k / arcs;
    auto q = c.at(p);
    if (k == arcs) q = {c.x_B, c.rho_B, c.sin_phi, c.cos_phi, 0.0, 1.0};
    add('R', p, q, 1 / c.r_t);
  }
  add('S', c.p_B, {c.x_B, c.rho_B, c.sin_phi, c.cos_phi, 0.0, 1.0}, 0);
  add('S', c.p_C, {c.x_C, c.rho_C, c.sin_phi, c.cos_phi, 0.0, 1.0}, 0);
  for (const double p : flank_steps(c, chord_mm)) {
    const auto q = c.flank(p);
    add('I', p, q, q.dS > 1e-9 ? -q.dpsi / q.dS : 0);
  }
  samples.push_back({'Z', c.p_D, c.x_D + c.h_f, c.x_D, c.rho_D, 0, 0});
  return samples;
}

}  // namespace toothpath::bevel_gear
