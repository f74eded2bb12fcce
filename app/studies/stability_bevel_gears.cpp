// Extreme equal-base-circle bevel gears of the documentation, in double and in 50 digits.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/studies/stability_exact.h"
#include "app/studies/stability_rows.h"
#include "geometry/base/angle.h"
#include "geometry/bevel_gear/limits.h"

namespace toothpath::studies {
namespace {

struct BevelCase {
  std::string name;
  bevel_gear::BevelGearParameters gear;
  bevel_gear::FingerCutterData cutter;
  Expected expected = Expected::accept;
};

/// A pair of ordinary proportions; the cutter's module is `share` of the normal module at the small end.
BevelCase pair(std::string name, int teeth, int mate, double module_mm, double spiral_deg, double face_share,
               double share = 0.96) {
  BevelCase c;
  c.name = std::move(name);
  auto& p = c.gear;
  p.teeth = teeth;
  p.mate_teeth = mate;
  p.outer_transverse_module_mm = module_mm;
  p.pressure_angle_rad = radians(20);
  p.outer_spiral_angle_rad = radians(spiral_deg);
  p.form = bevel_gear::BevelForm::single;
  const double delta = mate > 0 ? std::atan2(double(teeth), double(mate)) : p.pitch_angle_rad;
  const double R_e = module_mm * teeth / (2 * std::sin(delta)), cos_beta = std::cos(radians(spiral_deg));
  p.face_width_mm = face_share * R_e;
  const double R_i = R_e - p.face_width_mm;
  const double normal_module = module_mm * R_i / R_e * std::sqrt(R_i / R_e) * cos_beta;
  const double m = share * normal_module;
  c.cutter = {m, 0.25 * m, 1.37 * m, 1.6 * m};
  p.addendum_mm = 1.37 * m;
  p.dedendum_mm = 1.7 * m;
  return c;
}

/// The same for a pitch angle without a mate, the outer cone distance kept: teeth follow from it.
BevelCase pitch_angle(std::string name, int teeth, double delta_deg, double module_mm) {
  BevelCase c = pair(name, teeth, teeth, module_mm, 30, 0.29);
  auto& p = c.gear;
  p.mate_teeth = 0;
  p.pitch_angle_rad = radians(delta_deg);
  const double R_e = module_mm * teeth / (2 * std::sin(p.pitch_angle_rad));
  p.face_width_mm = std::min(0.29 * R_e, 10 * module_mm);
  const double share = 1 - p.face_width_mm / R_e,
               m = 0.96 * module_mm * share * std::sqrt(share) * std::cos(radians(30));
  c.cutter = {m, 0.2 * m, 1.37 * m, 1.6 * m};
  p.addendum_mm = 1.37 * m;
  p.dedendum_mm = 1.7 * m;
  return c;
}

std::vector<BevelCase> cases() {
  std::vector<BevelCase> list;
  BevelCase w1{"18/37 m6, spiral 30", {}, {3.0, 0.9, 4.1, 4.8}};
  w1.gear.teeth = 18, w1.gear.mate_teeth = 37, w1.gear.outer_transverse_module_mm = 6,
  w1.gear.pressure_angle_rad = radians(20);
  w1.gear.outer_spiral_angle_rad = radians(30), w1.gear.face_width_mm = 36,
  w1.gear.form = bevel_gear::BevelForm::single;
  w1.gear.addendum_mm = 4.1, w1.gear.dedendum_mm = 5.1;
  list.push_back(w1);
  BevelCase wheel = w1;
  wheel.name = "37/18 m6, spiral 30, left";
  wheel.gear.teeth = 37, wheel.gear.mate_teeth = 18, wheel.gear.hand = -1, wheel.cutter.tip_radius_mm = 0.6;
  list.push_back(wheel);
  BevelCase herringbone = w1;
  herringbone.name = "18/37 m6, herringbone";
  herringbone.gear.form = bevel_gear::BevelForm::herringbone, herringbone.gear.apex_cone_distance_mm = 104,
  herringbone.gear.relief_half_width_mm = 3.2;
  list.push_back(herringbone);
  list.push_back(pair("spiral 0 at the outer end", 25, 25, 5, 0, 0.22));
  list.push_back(pair("spiral 5 deg", 25, 25, 5, 5, 0.22));
  list.push_back(pair("spiral 45 deg, 12/60 m3", 12, 60, 3, 45, 0.25));
  list.push_back(pair("7 teeth, pitch angle 9.9 deg", 7, 40, 4, 30, 0.25));
  list.push_back(pair("m 0.1", 18, 37, 0.1, 30, 0.29));
  list.push_back(pair("m 60", 18, 37, 60, 30, 0.29));
  list.push_back(pitch_angle("crown wheel, 90 deg", 40, 90, 6));
  list.push_back(pitch_angle("pitch angle 89.9999 deg", 40, 89.9999, 6));
  list.push_back(pitch_angle("pitch angle 0.01 deg", 18, 0.01, 6));
  list.push_back(pair("cutter as wide as the small end", 18, 37, 6, 30, 0.29, 1.0));
  list.push_back(pair("cutter wider than the small end", 18, 37, 6, 30, 0.29, 1.05));
  list.push_back(pair("face 0.55 of the cone distance", 18, 37, 6, 30, 0.55));
  list[list.size() - 1].cutter = w1.cutter;
  BevelCase apex = herringbone;
  apex.name = "apex at the end of the face";
  apex.gear.apex_cone_distance_mm = 88;
  list.push_back(apex);
  BevelCase backlash = w1;
  backlash.name = "backlash that eats the top land";
  backlash.gear.backlash_mm = 8;
  list.push_back(backlash);
  for (std::size_t k = list.size() - 5; k < list.size(); ++k) list[k].expected = Expected::refuse;
  return list;
}

}  // namespace

std::vector<StabilityRow> bevel_gear_rows() {
  constexpr int kAlong = 9, kAcross = 7;
  std::vector<StabilityRow> rows;
  for (const BevelCase& c : cases()) {
    StabilityRow row{"bevel gear", c.name};
    const auto made = bevel_gear::BevelGear::make(c.gear, c.cutter);
    const auto* refusals = made.refused();
    if (refusals || c.expected == Expected::refuse) {
      judge_refusal(row, c.expected, refusals ? refusals->front().diagnostic.message : "");
      rows.push_back(row);
      continue;
    }
    const bevel_gear::BevelGear& gear = made.value();
    row.limit_mm = kRounding * kEps * gear.R_0();
    row.condition = gear.limits().least_regularity > 0 ? 1 / gear.limits().least_regularity : 0;
    for (const auto& half : gear.halves())
      for (const int sigma : {1, -1}) {
        const auto& wall = half.wall(sigma);
        const double from = half.beta_from[sigma > 0 ? 0 : 1], to = half.beta_to[sigma > 0 ? 0 : 1];
        for (int n = 0; n < kAlong; ++n)
          for (int k = 0; k < kAcross; ++k) {
            const double beta = from + (to - from) * n / (kAlong - 1);
            if (!(beta > 0) || wall.trace.straight(sigma, beta)) continue;
            const double p = wall.cutter.p_A + (wall.cutter.p_D - wall.cutter.p_A) * (k + 0.5) / kAcross;
            const auto compared = exact_bevel_point(gear, wall, beta, p);
            const double worst = std::max(compared.position_mm, compared.normal * c.gear.outer_transverse_module_mm);
            row.error_mm = worst <= row.error_mm ? row.error_mm : worst;  // keeps NaN
            const auto at = wall.generatrix(beta, p);
            if (const auto back = bevel_gear::bevel_inverse(wall, at[0], at[1]))
              row.iterations = std::max(row.iterations, back->iterations);
            ++row.points;
          }
      }
    judge(row, 0);
    if (!gear.warnings().empty() && row.reason.empty()) row.reason = gear.warnings().front();
    rows.push_back(row);
  }
  return rows;
}

}  // namespace toothpath::studies
