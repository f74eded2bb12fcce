#include "geometry/loaded/friction.h"

#include <algorithm>
#include <cmath>

namespace toothpath::loaded {
namespace {

constexpr double kStill = 1e-9;  // of the base radius

Turning turning_of(const LoadedPair& pair, const PairRing& ring) {
  Turning out;
  out.pinion_axis = ring.moved.a, out.pinion_origin = ring.moved.foot;
  out.ratio = static_cast<double>(pair.pinion_teeth) / pair.teeth;
  out.still_mm = kStill * ring.moved.r_b;
  return out;
}

}  // namespace

Vec3 sliding(const Turning& turning, const Vec3& point) {
  return turning.pinion_axis.cross(point - turning.pinion_origin) -
         turning.ratio * turning.gear_axis.cross(point - turning.gear_origin);
}

Vec3 sliding(const LoadedPair& pair, const PairRing& ring, const Vec3& point) {
  return sliding(turning_of(pair, ring), point);
}

Friction friction_of(const std::function<Turning(int ring)>& turning, const LoadedPosition& position, double torque_nmm,
                     double mu) {
  Friction out;
  for (const PressedSegment& s : position.segments) {
    if (!(s.force > 0)) continue;
    const Turning turns = turning(s.place.ring);
    Vec3 v = sliding(turns, s.place.nearest);
    if (s.place.on_edge) v -= s.place.normal * v.dot(s.place.normal);  // an edge also comes nearer, or leaves
    const double speed = v.norm();
    if (!(speed > turns.still_mm)) continue;
    const Vec3 on_gear = v * (mu * s.force / speed);
    const double axial = -on_gear.dot(turns.pinion_axis),
                 moment = (s.place.nearest - turns.gear_origin).cross(on_gear).dot(turns.gear_axis);
    out.axial_n += axial, out.axial_bound_n += std::abs(axial);
    out.torque_part += moment, out.torque_bound += std::abs(moment);
  }
  if (torque_nmm > 0) out.torque_part /= torque_nmm, out.torque_bound /= torque_nmm;
  return out;
}

Friction friction_of(const LoadedPair& pair, const LoadedPosition& position, double mu) {
  const auto turning = [&](int ring) {
    return turning_of(
        pair, *std::find_if(pair.rings.begin(), pair.rings.end(), [&](const auto& r) { return r.ring == ring; }));
  };
  return friction_of(turning, position, position.gear_torque_nmm, mu);
}

}  // namespace toothpath::loaded
