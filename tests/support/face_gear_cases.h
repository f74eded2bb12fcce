// The face gears that the tests speak of: both samples, the extreme cases of docs/face_gear.md, random ones.
#pragma once

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"

namespace toothpath::test {

/// A gear with one zone and the limits that the documentation prints. NaN: no such limit.
struct FaceGearCase {
  std::string name;
  int shaper_teeth = 0, teeth = 0;
  double module_mm = 0, alpha_deg = 0, beta_deg = 0, offset_mm = 0, gamma_deg = 90, addendum = 1;
  bool transverse = false;
  double tip_radius_mm = 0;
  double undercut[2] = {};        // R1c of side +1, -1
  double involute_start[2] = {};  // R1b
  double pointing = 0, land = 0;  // R2, R2'

  [[nodiscard]] face_gear::FaceGearParameters parameters() const {
    face_gear::FaceGearParameters g;
    g.teeth = teeth;
    g.shaper_teeth = shaper_teeth;
    g.module_mm = module_mm;
    g.module_plane = transverse ? face_gear::ModulePlane::transverse : face_gear::ModulePlane::normal;
    g.pressure_angle_rad = radians(alpha_deg);
    g.addendum_coefficient = addendum;
    g.shaft_angle_rad = radians(gamma_deg);
    g.offset_mm = offset_mm;
    g.shaper_tip_radius_mm = tip_radius_mm;
    return g;
  }
  [[nodiscard]] double beta() const { return radians(beta_deg); }
  template <typename S = double>
  [[nodiscard]] face_gear::FaceGearSurface<S> surface() const {
    return face_gear::make_surface<S>(parameters(), beta());
  }
};
/// Name of a parameterized test.
inline constexpr auto name_of_case = [](const auto& info) { return info.param.name; };

inline std::ostream& operator<<(std::ostream& out, const FaceGearCase& c) { return out << c.name; }

inline const std::vector<FaceGearCase>& extreme_cases() {
  constexpr double no = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<FaceGearCase> cases = {
      {"spur_25_88",
       25,
       88,
       3,
       20,
       0,
       0,
       90,
       1,
       false,
       0,
       {126.4226, 126.4226},
       {126.8976, 126.8976},
       150.8443,
       146.9770},
      {"beta_1e_6",
       25,
       88,
       3,
       20,
       1e-6,
       0,
       90,
       1,
       false,
       0,
       {126.4226, 126.4226},
       {126.8976, 126.8976},
       150.8443,
       146.9770},
      {"beta_1e_10",
       25,
       88,
       3,
       20,
       1e-10,
       0,
       90,
       1,
       false,
       0,
       {126.4226, 126.4226},
       {126.8976, 126.8976},
       150.8443,
       146.9770},
      {"beta_45", 20, 100, 2, 20, 45, 0, 90, 1, false, 0, {141.7327, no}, {no, no}, 172.3303, 168.2935},
      {"few_teeth", 10, 30, 2, 20, 0, 0, 90, 1, false, 0, {29.5785, 29.5785}, {33.4783, 33.4783}, 36.1558, 34.7205},
      {"few_teeth_low",
       10,
       30,
       2,
       25,
       0,
       0,
       90,
       0.6,
       false,
       0,
       {28.3585, 28.3585},
       {28.0858, 28.0858},
       42.1420,
       40.1940},
      {"many_teeth", 60, 720, 1, 20, 20, 0, 90, 1, false, 0, {363.8185, no}, {no, no}, 422.0275, 415.5261},
      {"sixty_teeth", 60, 180, 1, 20, 0, 0, 90, 1, false, 0, {85.8695, 85.8695}, {no, no}, 98.7583, 97.1647},
      {"module_0_2", 18, 72, 0.2, 25, 0, 0, 90, 1, false, 0, {6.6836, 6.6836}, {6.6609, 6.6609}, 8.2281, 7.9414},
      {"module_30",
       16,
       96,
       30,
       20,
       10,
       0,
       90,
       1,
       false,
       0,
       {1417.763, no},
       {1454.9975, 1483.6655},
       1715.3209,
       1660.7051},
      {"alpha_14_5",
       30,
       150,
       2,
       14.5,
       0,
       0,
       90,
       1,
       false,
       0,
       {146.3014, 146.3014},
       {150.8367, 150.8367},
       170.8543,
       167.3451},
      {"alpha_25_beta_25",
       14,
       42,
       4,
       25,
       25,
       0,
       90,
       1,
       false,
       0,
       {94.2789, no},
       {82.0024, 86.7365},
       108.9798,
       104.8501},
      {"offset_45", 25, 88, 3, 20, 0, 45, 90, 1, false, 0, {no, 140.4391}, {137.0178, 132.2200}, 157.3703, 153.8261},
      {"offset_minus_45",
       25,
       88,
       3,
       20,
       0,
       -45,
       90,
       1,
       false,
       0,
       {140.4391, no},
       {132.2200, 137.0178},
       157.3703,
       153.8261},
      {"offset_90", 25, 88, 3, 20, 0, 90, 90, 1, false, 0, {no, 164.3987}, {159.6707, 151.3646}, 175.4984, 172.6578},
      {"gamma_60",
       25,
       88,
       3,
       20,
       0,
       0,
       60,
       1,
       false,
       0,
       {125.3034, 125.3034},
       {127.2016, 127.2016},
       152.8224,
       148.7399},
      {"gamma_120",
       25,
       88,
       3,
       20,
       0,
       0,
       120,
       1,
       false,
       0,
       {127.0132, 127.0132},
       {126.4979, 126.4979},
       148.6907,
       145.0579},
      {"gamma_75_mixed", 22, 75, 2, 25, 15, 6, 75, 1, false, 0, {72.5607, 68.0711}, {no, no}, 87.4954, 84.6493},
      {"gamma_110_mixed", 28, 112, 2.5, 20, -20, -10, 110, 1, false, 0, {no, 143.7776}, {no, no}, 165.0636, 161.2387},
      {"dhfg_transverse",
       30,
       180,
       5,
       20,
       30,
       0,
       90,
       1,
       true,
       0,
       {448.0895, no},
       {421.3513, 430.2918},
       508.6455,
       496.7803},
      {"dhfg_normal", 30, 180, 5, 20, 30, 0, 90, 1, false, 0, {508.4301, no}, {no, no}, 597.6358, 584.8727},
      {"offset_15",
       25,
       88,
       3,
       20,
       0,
       15,
       90,
       1,
       false,
       0,
       {124.42744, 129.79653},
       {128.62070, 126.93583},
       151.58330,
       147.75491},
  };
  return cases;
}

inline FaceGearCase case_named(const std::string& name) {
  for (const auto& c : extreme_cases())
    if (c.name == name) return c;
  throw std::invalid_argument("no case " + name);
}

/// A point of a flank in its parameters.
struct FlankSample {
  int side = 1;
  double theta = 0, B = 0;
};

/// Points of both flanks between the limits (R1 .. R2'), fillet line and tip surface, edges left out by a hair.
inline std::vector<FlankSample> trimmed_flank(const face_gear::FaceGearSurface<double>& f, double module_mm, int radii,
                                              int heights) {
  std::vector<FlankSample> samples;
  const auto limits = face_gear::zone_limits(f, module_mm);
  if (!limits.land_radius || *limits.land_radius <= limits.inner_limit) return samples;
  const double hair = 1e-3 * module_mm;
  for (int n = 0; n < radii; ++n) {
    const double t = radii > 1 ? double(n) / (radii - 1) : 0.5;
    const double r = (limits.inner_limit + hair) * (1 - t) + *limits.land_radius * t;
    for (const int side : {1, -1}) {
      const auto low = face_gear::fillet_line_height(f, side, r);
      if (!low) continue;
      const double top = f.z_tip(r);
      for (int k = 0; k < heights; ++k) {
        const double z = *low + hair + (top - *low - hair) * (heights > 1 ? double(k) / (heights - 1) : 0.5);
        if (const auto at = face_gear::invert_flank(f, side, r, z)) samples.push_back({side, at->theta, at->B});
      }
    }
  }
  return samples;
}

/// Random gears that a job could ask for: every limit sane, all of helix, offset, shaft angle and tip radius in play.
inline std::vector<FaceGearCase> random_cases(unsigned seed, int count) {
  std::mt19937_64 generator(seed);
  const auto between = [&](double lo, double hi) { return lo + (hi - lo) * double(generator() >> 11) * 0x1p-53; };
  std::vector<FaceGearCase> cases;
  while (int(cases.size()) < count) {
    FaceGearCase c;
    c.shaper_teeth = int(between(16, 45));
    c.teeth = int(c.shaper_teeth * between(2.5, 7));
    c.module_mm = std::exp(between(std::log(0.5), std::log(12)));
    c.alpha_deg = between(17, 26);
    c.beta_deg = between(-35, 35);
    c.gamma_deg = between(65, 115);
    c.transverse = generator() % 2 == 0;
    c.offset_mm = between(-0.12, 0.12) * c.module_mm * c.teeth;
    const auto p = c.parameters();
    if (!face_gear::check_shaper(p, c.beta())) continue;
    c.tip_radius_mm = between(0, 0.8) * largest_tip_radius(p, c.beta());
    const auto f = c.surface();
    const auto limits = face_gear::zone_limits(f, c.module_mm);
    if (!limits.land_radius || *limits.land_radius < limits.inner_limit + c.module_mm) continue;
    c.name = "random_" + std::to_string(seed) + "_" + std::to_string(cases.size());
    cases.push_back(c);
  }
  return cases;
}

}  // namespace toothpath::test
