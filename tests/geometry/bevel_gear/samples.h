// The gears of the worked values W1..W4 and helpers for the bevel gear tests.
#pragma once

#include <gtest/gtest.h>

#include "geometry/base/angle.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/bevel_gear/limits.h"

namespace toothpath::bevel_test {

inline bevel_gear::BevelGearParameters w1() {
  bevel_gear::BevelGearParameters p;
  p.teeth = 18;
  p.mate_teeth = 37;
  p.shaft_angle_rad = kPi / 2;
  p.outer_transverse_module_mm = 6;
  p.pressure_angle_rad = radians(20);
  p.outer_spiral_angle_rad = radians(30);
  p.face_width_mm = 36;
  p.form = bevel_gear::BevelForm::single;
  p.hand = 1;
  p.addendum_mm = 4.1;
  p.dedendum_mm = 5.1;
  return p;
}
inline bevel_gear::BevelGearParameters w2() {
  bevel_gear::BevelGearParameters p = w1();
  p.teeth = 37;
  p.mate_teeth = 18;
  p.hand = -1;
  return p;
}
inline bevel_gear::BevelGearParameters w3() {
  bevel_gear::BevelGearParameters p = w1();
  p.form = bevel_gear::BevelForm::herringbone;
  p.apex_cone_distance_mm = 104;
  p.relief_half_width_mm = 3.2;
  return p;
}
inline bevel_gear::BevelGearParameters w4() {
  bevel_gear::BevelGearParameters p = w3();
  p.teeth = 37;
  p.mate_teeth = 18;
  p.hand = -1;
  return p;
}
inline bevel_gear::FingerCutterData pinion_mill() { return {3.0, 0.9, 4.1, 4.8}; }
inline bevel_gear::FingerCutterData wheel_mill() { return {3.0, 0.6, 4.1, 4.8}; }

inline bevel_gear::BevelGear made(const bevel_gear::BevelGearParameters& p, const bevel_gear::FingerCutterData& c) {
  auto g = bevel_gear::BevelGear::make(p, c);
  if (const auto* bad = g.refused()) {
    for (const auto& r : *bad) ADD_FAILURE() << r.key << ": " << r.diagnostic.message;
  }
  return g.value();
}

/// A gear by the design rules of the samples: h_a = m_n(R_m), h_f = 1.25 m_n(R_m), m_nj = 0.97 m_n(R_i), r_t 0.8 of its
/// limit.
struct Designed {
  bevel_gear::BevelGearParameters p;
  bevel_gear::FingerCutterData c;
};
inline Designed design(int teeth, int mate, double m, double beta_deg, double width_share, int hand = 1,
                       double pitch_angle_deg = 0) {
  Designed d;
  d.p = w1();
  d.p.teeth = teeth;
  d.p.mate_teeth = mate;
  d.p.pitch_angle_rad = radians(pitch_angle_deg);
  d.p.outer_transverse_module_mm = m;
  d.p.outer_spiral_angle_rad = radians(beta_deg);
  d.p.hand = hand;
  const double delta = bevel_gear::bevel_pitch_angle(d.p), R_e = teeth * m / (2 * std::sin(delta)),
               R_0 = R_e / std::pow(std::cos(radians(beta_deg)), 2);
  d.p.face_width_mm = width_share * R_e;
  const auto m_n = [&](double R) { return 2 * std::sin(delta) / teeth * R * std::sqrt(R / R_0); };
  const double R_m = R_e - d.p.face_width_mm / 2, R_i = R_e - d.p.face_width_mm;
  d.p.addendum_mm = m_n(R_m);
  d.p.dedendum_mm = 1.25 * m_n(R_m);
  d.c = {0.97 * m_n(R_i), 0.1, d.p.addendum_mm, 1.15 * d.p.addendum_mm};
  const double kappa = std::cos(delta) / (R_0 * std::sin(delta));
  d.c.tip_radius_mm = 0.8 * largest_tip_radius(bevel_gear::make_finger_profile<double>(
                                d.p.pressure_angle_rad, kappa, d.p.dedendum_mm, d.c.module_mm, 1e-3 * m,
                                d.c.rack_depth_mm, d.c.profile_height_mm));
  return d;
}
inline bevel_gear::BevelGear gear_of(const Designed& d) { return made(d.p, d.c); }

/// Brute force, knowing no meshing equation: smallest signed distance of a blank point to the solid cutter over all
/// instants of one pass, by sampling and golden section. The cutter is known only as a solid of revolution, the pass
/// only as positions (R_c, e) over its parameter.
inline double clearance_of_pass(const Vec3& point, const bevel_gear::BevelTrace<double>& t, int sigma, double beta_from,
                                double beta_to, const bevel_gear::FingerSolid& solid, int samples = 400) {
  const auto distance = [&](double beta) {
    const auto c = t.centre(sigma, beta);
    return solid.signed_distance(bevel_gear::cutter_from_blank<double>(point, c.R_c, c.e, t.sin_delta, t.cos_delta));
  };
  double best = std::numeric_limits<double>::infinity();
  int at = 0;
  for (int i = 0; i <= samples; ++i) {
    const double d = distance(beta_from + (beta_to - beta_from) * i / samples);
    if (d < best) best = d, at = i;
  }
  double a = beta_from + (beta_to - beta_from) * std::max(0, at - 1) / samples;
  double b = beta_from + (beta_to - beta_from) * std::min(samples, at + 1) / samples;
  const double g = 0.5 * (std::sqrt(5.0) - 1);
  double x1 = b - g * (b - a), x2 = a + g * (b - a), f1 = distance(x1), f2 = distance(x2);
  for (int k = 0; k < 70; ++k) {
    if (f1 < f2) b = x2, x2 = x1, f2 = f1, x1 = b - g * (b - a), f1 = distance(x1);
    else a = x1, x1 = x2, f1 = f2, x2 = a + g * (b - a), f2 = distance(x2);
  }
  return std::min({best, f1, f2});
}

}  // namespace toothpath::bevel_test
