// Spiral bevel gears that tests share: pinion and gear of NASA CR-191009, settings in mm and degrees.
#pragma once

#include "geometry/base/angle.h"
#include "geometry/spiral_bevel/basic_settings.h"
#include "geometry/spiral_bevel/gear.h"

namespace toothpath::test {

inline spiral_bevel::SpiralBevelParameters nasa_gear() {
  spiral_bevel::SpiralBevelParameters g;
  g.teeth = 36;
  g.hand = 1;
  g.pitch_angle_rad = radians(71.5666666);
  g.outer_cone_distance_mm = 93.7514;
  g.face_width_mm = 25.4;
  g.tip_angle_rad = radians(73.1333332);
  g.bore_diameter_mm = 60;
  spiral_bevel::Cut cut;
  cut.blades = {{{77.0255, radians(22), 0.7}, {75.3745, radians(22), 0.7}}};
  cut.radial_distance_mm = 72.642731192;
  cut.cradle_angle_rad = radians(59.2342023);
  cut.root_angle_rad = radians(67.683333267);
  cut.ratio_of_roll = 1.051674445;
  g.cuts = {cut};
  return g;
}

inline spiral_bevel::SpiralBevelParameters nasa_pinion() {
  spiral_bevel::SpiralBevelParameters g;
  g.teeth = 12;
  g.hand = -1;
  g.pitch_angle_rad = radians(18.4333333);
  g.outer_cone_distance_mm = 93.7514;
  g.face_width_mm = 25.4;
  g.tip_angle_rad = radians(22.3166667);
  g.mean_space_width_mm = 6.1;
  g.bore_diameter_mm = 16;
  spiral_bevel::Cut concave, convex;
  concave.flank = spiral_bevel::Cuts::concave;
  concave.blades[0] = {75.326783003, radians(18.045669752), 0.8};
  concave.radial_distance_mm = 74.874171554;
  concave.cradle_angle_rad = radians(63.942030463);
  concave.root_angle_rad = radians(16.86666664);
  concave.work_offset_mm = 3.926227758;
  concave.sliding_base_mm = 0.296487394;
  concave.machine_center_mm = -1.021857659;
  concave.ratio_of_roll = 3.242698536;
  convex.flank = spiral_bevel::Cuts::convex;
  convex.blades[1] = {78.011176388, radians(24.337423854), 0.8};
  convex.radial_distance_mm = 71.146656284;
  convex.cradle_angle_rad = radians(53.925994547);
  convex.root_angle_rad = radians(16.86666664);
  convex.work_offset_mm = -4.426244511;
  convex.sliding_base_mm = -0.399016782;
  convex.machine_center_mm = 1.375229989;
  convex.ratio_of_roll = 3.105176807;
  g.cuts = {concave, convex};
  return g;
}

/// The gear with blades so steep that it is nearly undercut: below 8.2801 deg it is.
inline spiral_bevel::SpiralBevelParameters steep_gear(double blade_deg) {
  auto g = nasa_gear();
  for (auto& blade : g.cuts[0].blades) blade.pressure_angle_rad = radians(blade_deg);
  return g;
}

/// The gear's cutter set so that it cuts the wheel by plunging, without a roll.
inline spiral_bevel::SpiralBevelParameters formate_wheel() {
  auto g = nasa_gear();
  g.cuts[0].generated = false;
  g.cuts[0].ratio_of_roll = 0;
  return g;
}

/// A wheel of that size without a spiral: its contact lines run along the circles of the blades.
inline spiral_bevel::SpiralBevelParameters zerol_gear() {
  spiral_bevel::Drawing d;
  d.teeth = 36;
  d.mate_teeth = 12;
  d.outer_transverse_module_mm = 4.941;
  d.pressure_angle_rad = radians(20);
  d.face_width_mm = 25.4;
  d.cutter_radius_mm = 76.2;
  auto g = spiral_bevel::basic_settings(d, 0.7).value();
  g.bore_diameter_mm = 60;
  return g;
}

/// Both flanks of the gear in one cut, with a leaning cutter and a modified roll.
inline spiral_bevel::SpiralBevelParameters tilted_gear() {
  auto g = nasa_gear();
  g.cuts[0].tilt_rad = radians(1.5);
  g.cuts[0].swivel_rad = radians(-40);
  g.cuts[0].modified = {0.02, -0.03};
  return g;
}

}  // namespace toothpath::test
