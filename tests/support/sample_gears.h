// The face gears of the samples and of the worked examples as parameters: one place for tests and benches.
#pragma once

#include <stdexcept>
#include <variant>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/face_gear.h"

namespace toothpath::test {

/// The double helical gear of the DHFG paper (30/180, 20 deg, module 5 in the transverse plane), lengths times `scale`; scale 1/4 is
/// samples/dhfg_t600s.toml.
inline FaceGearParameters double_helical_parameters(double scale = 1) {
  FaceGearParameters g;
  g.teeth = 180;
  g.shaper_teeth = 30;
  g.module_mm = 5 * scale;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.reference_radius_mm = 472 * scale;
  g.shaper_tip_radius_mm = 1.5 * scale;
  g.groove_depth_mm = 12.5 * scale;
  g.zones = {{radians(-30), 449 * scale, 468 * scale}, {radians(30), 476 * scale, 496 * scale}};
  return g;
}
inline FaceGearParameters quarter_dhfg() { return double_helical_parameters(0.25); }

/// The orthogonal pair 25/88, module 3: straight teeth, sharp shaper, no offset.
inline FaceGearParameters spur_parameters() {
  FaceGearParameters g;
  g.teeth = 88;
  g.shaper_teeth = 25;
  g.module_mm = 3;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.zones = {{0, 130.5, 147}};
  return g;
}

/// The same with 15 mm of offset and a rounded shaper tip: samples/offset_milled.toml.
inline FaceGearParameters offset_gear() {
  auto g = spur_parameters();
  g.offset_mm = 15;
  g.shaper_tip_radius_mm = 0.9;
  return g;
}

/// 20/60, module 2, short straight teeth: samples/spur_quick.toml.
inline FaceGearParameters small_spur() {
  FaceGearParameters g;
  g.teeth = 60;
  g.shaper_teeth = 20;
  g.module_mm = 2;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.shaper_tip_radius_mm = 0.6;
  g.zones = {{0, 60, 65}};
  return g;
}

/// Helix, offset and a shaft angle of 75 deg at once.
inline FaceGearParameters conical_gear() {
  FaceGearParameters g;
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
inline FaceGear made(const FaceGearParameters& parameters) {
  auto gear = FaceGear::make(parameters);
  if (auto* refused = std::get_if<std::vector<FaceGearRefusal>>(&gear))
    throw std::runtime_error(refused->front().key + ": " + refused->front().diagnostic.message);
  return std::get<FaceGear>(std::move(gear));
}

}  // namespace toothpath::test
