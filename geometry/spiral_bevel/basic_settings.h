// Settings of a generator for a spiral bevel gear of which only a drawing is there: one cut for both flanks by spread
// blades on a machine without offset, tilt and modified roll. docs/spiral_bevel_gear.md 6
#pragma once

#include <optional>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/spiral_bevel/parameters.h"

namespace toothpath::spiral_bevel {

/// What a drawing says. mm and rad
struct Drawing {
  int teeth = 0, mate_teeth = 0;
  int hand = 1;  ///< 1: right
  double shaft_angle_rad = 1.5707963267948966;
  double outer_transverse_module_mm = 0;
  double spiral_angle_rad = 0;    ///< in the middle of the face, >= 0
  double pressure_angle_rad = 0;  ///< normal
  double face_width_mm = 0;       ///< along the pitch cone
  double cutter_radius_mm = 0;
};

[[nodiscard]] double pitch_angle(const Drawing& drawing);
[[nodiscard]] double outer_cone_distance(const Drawing& drawing);
/// Of the pair of which one gear has this pitch angle and `ratio` teeth of the mate to one of its own; nothing: no
/// angle does.  sin(S - d) = ratio sin(d), S - d below a right angle
[[nodiscard]] std::optional<double> shaft_angle_of(double pitch_angle_rad, double ratio);

/// Both gears of a pair come from the same drawing with teeth exchanged and the other hand.
/// @param edge_radius_mm  rounding of both blades
/// Refused, with keys of a job: a cutter that does not make the spiral angle in the middle of the face; shafts that one
/// of both gears could not mesh at with teeth outside its cone.
[[nodiscard]] Expected<SpiralBevelParameters, Refusal> basic_settings(const Drawing& drawing, double edge_radius_mm);

}  // namespace toothpath::spiral_bevel
