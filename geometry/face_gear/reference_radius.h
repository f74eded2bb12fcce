// L0 of a face gear: one for all rings, else they would be out of phase.
#pragma once

#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// The stated one, or L_p of the first zone; mm.
[[nodiscard]] inline double reference_radius_of(const FaceGearParameters& gear) {
  if (gear.reference_radius_mm) return *gear.reference_radius_mm;
  return make_surface<double>(gear, gear.zones.front().helix_angle_rad).L_p;
}

}  // namespace toothpath::face_gear
