#include "geometry/loaded_bevel/bevel_friction.h"

namespace toothpath::loaded_bevel {

loaded::Turning turning_of(const LoadedBevelPair& pair) {
  constexpr double kStill = 1e-9;  // of the pinion's mean pitch radius
  const auto& pinion = pair.pair.pinion();
  loaded::Turning out;
  out.gear_axis = pair.pair.wheel_axis(), out.gear_origin = pair.pair.wheel_apex();
  out.pinion_axis = Vec3::UnitZ(), out.pinion_origin = Vec3::Zero();
  out.ratio = -1 / pair.pair.ratio();  // both axes point away from the common apex
  out.still_mm = kStill * pinion.R_m() * pinion.sin_delta();
  return out;
}

loaded::Friction friction_of(const LoadedBevelPair& pair, const loaded::LoadedPosition& position, double mu) {
  return loaded::friction_of([turning = turning_of(pair)](int) { return turning; }, position, position.gear_torque_nmm,
                             mu);
}

}  // namespace toothpath::loaded_bevel
