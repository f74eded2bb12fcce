// What defines a cylindrical involute gear: the numbers of a job's [gear] table, in mm and rad.
#pragma once

#include <optional>
#include <vector>

#include "geometry/base/module_plane.h"

namespace toothpath::cylindrical {

/// One ring of teeth between two heights. Two of opposite hand make a double helical gear.
struct CylindricalZone {
  double helix_angle_rad = 0;     ///< beta on the reference cylinder, > 0 right hand
  double from_mm = 0, to_mm = 0;  ///< along z
};

/// Symbols: z, m, alpha, x, h_a*, h_f*, rho*, A_s. Coefficients count in modules as given, in either plane.
struct CylindricalParameters {
  int teeth = 0;
  double module_mm = 0;
  ModulePlane module_plane = ModulePlane::normal;
  double pressure_angle_rad = 0;
  double profile_shift = 0;
  double addendum_coefficient = 1;
  double dedendum_coefficient = 1.25;
  double root_radius_coefficient = 0.38;          ///< rounding of the rack's tip, in the rack's normal plane
  std::optional<double> tip_diameter_mm = {};     ///< default: d + 2 m (x + h_a*)
  double thickness_allowance_mm = 0;              ///< <= 0: normal tooth thickness, both flanks together
  double least_land = 0.2;                        ///< of the top land, in modules
  double bore_diameter_mm = 0;                    ///< 0: none
  std::optional<double> groove_diameter_mm = {};  ///< between two zones; default: root diameter less half a module
  std::vector<CylindricalZone> zones;
};

}  // namespace toothpath::cylindrical
