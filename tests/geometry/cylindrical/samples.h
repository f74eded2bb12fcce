// Cylindrical gears that tests share.
#pragma once

#include <vector>

#include "geometry/base/angle.h"
#include "geometry/cylindrical/gear.h"

namespace toothpath::test {

inline cylindrical::CylindricalParameters shifted_spur() {
  cylindrical::CylindricalParameters g;
  g.teeth = 24;
  g.module_mm = 3;
  g.pressure_angle_rad = radians(20);
  g.profile_shift = 0.2;
  g.bore_diameter_mm = 25;
  g.zones = {{0, -10, 10}};
  return g;
}

/// The mate of the double helical face gear of docs: transverse reading, thinned, two hands.
inline cylindrical::CylindricalParameters double_helical_pinion() {
  cylindrical::CylindricalParameters g;
  g.teeth = 30;
  g.module_mm = 5;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.root_radius_coefficient = 0.3;
  g.tip_diameter_mm = 160;
  g.thickness_allowance_mm = -0.08;
  g.bore_diameter_mm = 60;
  g.groove_diameter_mm = 132;
  g.zones = {{radians(-30), -25, -3.3}, {radians(30), 3.3, 25}};
  return g;
}

inline cylindrical::CylindricalParameters left_helical() {
  cylindrical::CylindricalParameters g;
  g.teeth = 41;
  g.module_mm = 2;
  g.pressure_angle_rad = radians(25);
  g.profile_shift = -0.15;
  g.addendum_coefficient = 1.1;
  g.root_radius_coefficient = 0.25;
  g.thickness_allowance_mm = -0.03;
  g.zones = {{radians(-18), 4, 22}};
  return g;
}

inline std::vector<cylindrical::CylindricalParameters> cylindrical_samples() {
  return {shifted_spur(), double_helical_pinion(), left_helical()};
}

inline cylindrical::CylindricalGear made(const cylindrical::CylindricalParameters& g) {
  return cylindrical::CylindricalGear::make(g).value();
}

}  // namespace toothpath::test
