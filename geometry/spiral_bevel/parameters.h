// What defines a spiral bevel gear: the numbers of a job's [gear] table and the settings of its generator, in mm and
// rad. Names of the settings are those of REXS, signs stand in docs/spiral_bevel_gear.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace toothpath::spiral_bevel {

/// Which flanks one set-up of the machine cuts: the outside blades make the concave one, the inside blades the convex.
enum class Cuts : std::uint8_t { concave, convex, both };

/// One blade of the cutter.
struct Blade {
  double point_radius_mm = 0;  ///< where its line meets the tip plane, before rounding
  double pressure_angle_rad = 0;
  double edge_radius_mm = 0;  ///< rounding between blade and tip plane
};

/// One set-up of the machine.
struct Cut {
  Cuts flank = Cuts::both;
  bool generated = true;           ///< false: the flank is the cutter's cone (Formate)
  std::array<Blade, 2> blades{};   ///< outside, inside; of one flank only its own counts
  double radial_distance_mm = 0;   ///< S
  double cradle_angle_rad = 0;     ///< q, at roll 0
  double root_angle_rad = 0;       ///< of the machine
  double work_offset_mm = 0;       ///< E
  double sliding_base_mm = 0;      ///< X_B
  double machine_center_mm = 0;    ///< X_D, to the crossing point
  double ratio_of_roll = 0;        ///< work per cradle
  std::vector<double> modified{};  ///< 2C, 6D, 24E, ..
  double tilt_rad = 0, swivel_rad = 0;

  [[nodiscard]] bool makes(Cuts side) const { return flank == Cuts::both || flank == side; }
};

struct SpiralBevelParameters {
  int teeth = 0;
  int hand = 1;  ///< 1: right
  double shaft_angle_rad = 1.5707963267948966;
  double pitch_angle_rad = 0;
  double outer_cone_distance_mm = 0;
  double face_width_mm = 0;  ///< along the pitch cone, from the large end inwards
  double tip_angle_rad = 0;  ///< of the face cone
  double tip_apex_mm = 0;    ///< how far its apex lies beyond the crossing point, along -z
  std::optional<double> root_angle_rad = {}, root_apex_mm = {};  ///< checked against the cuts
  std::optional<double> mean_space_width_mm = {};                ///< arc on the pitch circle; two cuts only
  std::optional<double> backlash_mm = {};  ///< of the pair, on the outer pitch circle; two cuts only
  double bore_diameter_mm = 0, hub_diameter_mm = 0, hub_length_mm = 0;  ///< 0: none
  std::vector<Cut> cuts;                                                ///< one for both flanks, or one each

  [[nodiscard]] double mean_cone_distance() const { return outer_cone_distance_mm - 0.5 * face_width_mm; }
};

}  // namespace toothpath::spiral_bevel
