#include "geometry/loaded/friction.h"

#include <algorithm>
#include <cmath>

namespace toothpath::loaded {

Vec3 sliding(const LoadedPair& pair, const PairRing& ring, const Vec3& point) {
  const auto& pinion = ring.moved;
  const double ratio = static_cast<double>(pair.pinion_teeth) / pair.teeth;
  return pinion.a.cross(point - pinion.foot) - ratio * Vec3::UnitZ().cross(point);
}

Friction friction_of(const LoadedPair& pair, const LoadedPosition& position, double mu) {
  Friction out;
  double load = 0;
  for (const PressedSegment& s : position.segments) {
    load += s.force;
    if (!(s.force > 0)) continue;
    const auto ring =
        std::find_if(pair.rings.begin(), pair.rings.end(), [&](const auto& r) { return r.ring == s.place.ring; });
    const Vec3 v = sliding(pair, *ring, s.place.nearest);
    const double speed = v.norm();
    if (!(speed > 1e-9 * ring->moved.r_b)) continue;  // on the pitch line nothing slides
    const Vec3 on_gear = v * (mu * s.force / speed);
    const double axial = -on_gear.dot(ring->moved.a),
                 moment = s.place.nearest.x() * on_gear.y() - s.place.nearest.y() * on_gear.x();
    out.axial_n += axial, out.axial_bound_n += std::abs(axial);
    out.torque_part += moment, out.torque_bound += std::abs(moment);
  }
  if (load > 0) out.torque_part /= load * pair.lever, out.torque_bound /= load * pair.lever;
  return out;
}

}  // namespace toothpath::loaded
