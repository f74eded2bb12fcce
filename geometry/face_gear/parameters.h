// What defines a face gear: the numbers of a job's [gear] table, in mm and rad.
#pragma once

#include <optional>
#include <vector>

#include "geometry/base/module_plane.h"
#include "geometry/base/result.h"
#include "geometry/modification/modification.h"

namespace toothpath::face_gear {

using toothpath::ModulePlane;  ///< of module, pressure angle and the tooth height coefficients

/// One ring of teeth between two radii. Two rings of opposite hand make a double helical face gear.
struct FaceGearZone {
  double helix_angle_rad = 0;  ///< beta of the shaper, > 0 right hand
  double inner_radius_mm = 0;
  double outer_radius_mm = 0;
};

/// Symbols: module m, alpha, h_a*, c*, gamma, E, L0, N_s, N_2, rho, j_n.
struct FaceGearParameters {
  int teeth = 0;         ///< N_2
  int shaper_teeth = 0;  ///< N_s
  int mate_teeth = 0;    ///< N_p, pinion; 0: as the shaper
  double module_mm = 0;
  ModulePlane module_plane = ModulePlane::normal;
  double pressure_angle_rad = 0;
  double addendum_coefficient = 1.0;
  double clearance_coefficient = 0.25;
  double shaft_angle_rad = 1.5707963267948966;
  double offset_mm = 0;                       ///< E, signed
  std::optional<double> reference_radius_mm;  ///< L0; none: L_p of the first zone's reading
  double shaper_tip_radius_mm = 0;            ///< rho, in the shaper's transverse plane
  double backlash_mm = 0;                     ///< j_n, normal
  double groove_depth_mm = -1;                ///< below the tip surface at mid-groove; < 0: 0.25 m below the root
  double allowance_top_mm = 0;                ///< stock above the tip surface
  std::vector<FaceGearZone> zones;            ///< from the inside outwards, not overlapping
  std::optional<double> least_land_mm = {};   ///< top land that the tooth should have at least; none: 0.2 m
  std::vector<modification::Modification> modifications = {};  ///< of the flanks
};

}  // namespace toothpath::face_gear
