// The face gears of the samples and of the worked examples as parameters: one place for tests and benches.
#pragma once

#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::test {

/// Cut by a shaper of 20 deg, the module in the transverse plane.
inline face_gear::FaceGearParameters transverse_gear(int teeth, int shaper_teeth, double module_mm,
                                                     double shaper_tip_radius_mm,
                                                     std::vector<face_gear::FaceGearZone> zones) {
  face_gear::FaceGearParameters g;
  g.teeth = teeth;
  g.shaper_teeth = shaper_teeth;
  g.module_mm = module_mm;
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.shaper_tip_radius_mm = shaper_tip_radius_mm;
  g.zones = std::move(zones);
  return g;
}

/// The double helical gear of the DHFG paper (30/180, 20 deg, module 5 in the transverse plane), lengths times `scale`;
/// scale 1/4 is samples/dhfg_ball.toml.
inline face_gear::FaceGearParameters double_helical_parameters(double scale = 1) {
  auto g = transverse_gear(180, 30, 5 * scale, 1.5 * scale,
                           {{radians(-30), 449 * scale, 468 * scale}, {radians(30), 476 * scale, 496 * scale}});
  g.reference_radius_mm = 472 * scale;
  g.groove_depth_mm = 12.5 * scale;
  return g;
}
inline face_gear::FaceGearParameters quarter_dhfg() { return double_helical_parameters(0.25); }

/// The orthogonal pair 25/88, module 3: straight teeth, sharp shaper, no offset.
inline face_gear::FaceGearParameters spur_parameters() { return transverse_gear(88, 25, 3, 0, {{0, 130.5, 147}}); }

/// The same with 15 mm of offset and a rounded shaper tip: samples/offset_milled.toml.
inline face_gear::FaceGearParameters offset_gear() {
  auto g = spur_parameters();
  g.offset_mm = 15;
  g.shaper_tip_radius_mm = 0.9;
  return g;
}

/// 20/60, module 2, short straight teeth: samples/spur_quick.toml.
inline face_gear::FaceGearParameters small_spur() { return transverse_gear(60, 20, 2, 0.6, {{0, 60, 65}}); }

/// 20/30, module 5, an acute or obtuse shaft angle: at 70 deg the root stands far out along the shaper's axis, at 105
/// deg a tool along the gear axis does not fit.
inline face_gear::FaceGearParameters steep_gear(double shaft_angle_deg, double inner_radius_mm,
                                                double outer_radius_mm) {
  auto g = transverse_gear(30, 20, 5, 1, {{0, inner_radius_mm, outer_radius_mm}});
  g.shaft_angle_rad = radians(shaft_angle_deg);
  return g;
}

/// Helix, offset and a shaft angle of 75 deg at once.
inline face_gear::FaceGearParameters conical_gear() {
  face_gear::FaceGearParameters g;
  g.teeth = 75;
  g.shaper_teeth = 22;
  g.module_mm = 2;
  g.pressure_angle_rad = radians(25);
  g.offset_mm = 6;
  g.shaft_angle_rad = radians(75);
  g.shaper_tip_radius_mm = 0.4;
  g.zones = {{radians(15), 74, 84}};
  return g;
}

/// The gear; throws with key and message where FaceGear::make refuses.
inline face_gear::FaceGear made(const face_gear::FaceGearParameters& parameters) {
  auto gear = face_gear::FaceGear::make(parameters);
  if (auto* refused = gear.refused())
    throw std::runtime_error(refused->front().key + ": " + refused->front().diagnostic.message);
  return std::move(gear).value();
}

/// small_spur() with modified flanks.
inline face_gear::FaceGear modified_spur(const std::vector<modification::Modification>& modifications = {}) {
  auto g = small_spur();
  g.modifications = modifications;
  return made(g);
}

}  // namespace toothpath::test
