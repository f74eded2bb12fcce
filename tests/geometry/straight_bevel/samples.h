// Straight bevel gears that tests share.
#pragma once

#include "geometry/base/angle.h"
#include "geometry/straight_bevel/gear.h"

namespace toothpath::test {

/// 20 teeth against 40, module 3: the blank of KHK's example.
inline straight_bevel::StraightBevelParameters khk_pinion(straight_bevel::Form form = straight_bevel::Form::octoid) {
  straight_bevel::StraightBevelParameters g;
  g.teeth = 20;
  g.pitch_angle_rad = straight_bevel::pitch_angle(20, 40, radians(90));
  g.outer_transverse_module_mm = 3;
  g.pressure_angle_rad = radians(20);
  g.form = form;
  g.face_width_mm = 22;
  g.addendum_mm = 4.035;
  g.dedendum_mm = 2.529;
  g.tip_angle_rad = radians(30.48699);
  g.thickness_shift = 0.1256;
  g.fillet_radius_mm = 0.9;
  g.backlash_mm = 0.08;
  g.bore_diameter_mm = 16;
  return g;
}

}  // namespace toothpath::test
