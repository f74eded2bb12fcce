// Trial 4 of the nine double helical gears, as `study dhfg` makes it.
#pragma once

#include <stdexcept>

#include "geometry/base/angle.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::test {

inline face_gear::FaceGear trial_gear(int pinion_teeth = 30, int ratio = 6, double helix_deg = 30) {
  face_gear::FaceGearParameters p;
  p.teeth = pinion_teeth * ratio;
  p.shaper_teeth = pinion_teeth;
  p.module_mm = 5;
  p.pressure_angle_rad = radians(20);
  p.shaper_tip_radius_mm = 1.5;
  const double beta = radians(helix_deg);
  const auto limits = face_gear::zone_limits(face_gear::make_surface<double>(p, beta), p.module_mm);
  const double inner = limits.inner_limit + 1, outer = *limits.land_radius - 1, groove = (inner + outer) / 2;
  p.reference_radius_mm = groove;
  p.zones = {{-beta, inner, groove - 4}, {beta, groove + 4, outer}};
  auto made = face_gear::FaceGear::make(p);
  if (auto* refused = made.refused()) throw std::invalid_argument(refused->front().diagnostic.message);
  return std::move(made).value();
}

}  // namespace toothpath::test
