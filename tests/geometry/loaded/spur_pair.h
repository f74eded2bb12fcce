// The spur face gear of samples/spur_quick.toml and the pinion that is its shaper, on coarse bricks.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "geometry/base/angle.h"
#include "geometry/face_gear/flank_field.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::test {

constexpr double kSpurInner = 60, kSpurOuter = 65;

inline face_gear::FaceGear spur_gear(double shaper_tip_radius_mm = 0.6) {
  face_gear::FaceGearParameters p;
  p.teeth = 60, p.shaper_teeth = 20, p.module_mm = 2, p.pressure_angle_rad = radians(20);
  p.shaper_tip_radius_mm = shaper_tip_radius_mm;
  p.zones = {{0, kSpurInner, kSpurOuter}};
  auto made = face_gear::FaceGear::make(p);
  if (auto* refused = made.refused()) throw std::invalid_argument(refused->front().diagnostic.message);
  return std::move(made).value();
}
inline loaded::PairOptions spur_options() {
  loaded::PairOptions options;
  for (auto* body : {&options.gear, &options.pinion}) {
    body->bricks.across = 3, body->bricks.flank = 4, body->bricks.face = 5;
    body->bricks.rim_mm = 10;
  }
  options.pinion_fillet_mm = 0.48;
  options.segment_mm = 0.2;
  return options;
}
inline loaded::LoadedPair spur_pair(double shaper_tip_radius_mm = 0.6) {
  auto made = loaded::make_loaded_pair(spur_gear(shaper_tip_radius_mm), 1, 20, spur_options());
  if (!made) throw std::invalid_argument(made.error().message);
  return std::move(made).value();
}

/// Amounts in mm: crowning of the face, and relief of the gear's tip, a parabola of this length.
inline loaded::Removal relieved(const loaded::PairRing& ring, double crown, double tip, double length) {
  const auto surface = ring.surface;
  return [surface, crown, tip, length](const Vec3& p) {
    const double r = radius(p), x = (2 * r - kSpurInner - kSpurOuter) / (kSpurOuter - kSpurInner);
    const double depth = face_gear::FlankField::depth<double>(surface, p, r), t = 1 - depth / length;
    return crown * x * x + (t > 1 ? tip * (2 * t - 1) : t > 0 ? tip * t * t : 0);
  };
}

inline loaded::LoadedPosition spur_position(const loaded::LoadedPair& pair, double torque_Nm, double phase) {
  loaded::Load load;
  load.torque_nmm = torque_Nm * 1000;
  auto found = loaded::loaded_position(pair, load, 2 * kPi / 20 * phase);
  if (!found) throw std::invalid_argument(found.error().message);
  return std::move(found).value();
}
inline double force_of_tooth(const loaded::LoadedPosition& p, int tooth) {
  double sum = 0;
  for (const auto& s : p.segments)
    if (s.place.tooth == tooth) sum += s.force;
  return sum;
}

}  // namespace toothpath::test
