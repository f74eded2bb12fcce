// What defines a straight bevel gear: the numbers of a job's [gear] table, in mm and rad. Terms of ISO 23509.
#pragma once

#include <cstdint>
#include <optional>

namespace toothpath::straight_bevel {

/// Flanks of the crown gear that generates it: planes, or spherical involutes.
enum class Form : std::uint8_t { octoid, spherical_involute };

/// Lengths across the tooth count at the large end.
struct StraightBevelParameters {
  int teeth = 0;
  double pitch_angle_rad = 0;
  double outer_transverse_module_mm = 0;
  double pressure_angle_rad = 0;  ///< of the crown gear
  Form form = Form::octoid;
  double face_width_mm = 0;  ///< along the pitch cone, from the large end inwards
  double addendum_mm = 0;    ///< along the back cone
  double dedendum_mm = 0;
  std::optional<double> tip_angle_rad = {};  ///< of the face cone; default: its apex in the pitch apex
  double thickness_shift = 0;                ///< half of the tooth's excess on the outer pitch circle, in modules
  double fillet_radius_mm = 0;               ///< rounding of the crown gear's tooth tip
  double backlash_mm = 0;                    ///< of the pair, on the outer pitch circle
  double least_land = 0.2;                   ///< of the top land, in modules
  double bore_diameter_mm = 0, hub_diameter_mm = 0, hub_length_mm = 0;  ///< 0: none
};

/// Pitch angle of a gear that meets a mate of `mate_teeth` at a shaft angle.
[[nodiscard]] double pitch_angle(int teeth, int mate_teeth, double shaft_angle_rad);

}  // namespace toothpath::straight_bevel
