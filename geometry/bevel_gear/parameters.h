// What defines an equal-base-circle bevel gear: the numbers of a job's [gear] table, in mm and rad.
#pragma once

#include <optional>
#include <vector>

#include "geometry/modification/modification.h"

namespace toothpath::bevel_gear {

/// What a finger mill is ordered by; lengths mm.
struct FingerCutterData {
  double module_mm = 0;          ///< m_nj
  double tip_radius_mm = 0;      ///< r_t
  double rack_depth_mm = 0;      ///< h_C
  double profile_height_mm = 0;  ///< x_D
};

/// Two halves of opposite hand that meet at the apex cone distance, or one hand over the whole face.
enum class BevelForm { herringbone, single };

/// Symbols: z, m_te, alpha_n, beta_e, delta, b, R_J, h_a, h_f, j_t.
struct BevelGearParameters {
  int teeth = 0;
  int mate_teeth = 0;  ///< 0: no mate, then `pitch_angle_rad` is given
  double shaft_angle_rad = 1.5707963267948966;
  double pitch_angle_rad = 0;  ///< delta; computed from the mate when there is one
  double outer_transverse_module_mm = 0;
  double pressure_angle_rad = 0;  ///< alpha_n
  double outer_spiral_angle_rad = 0;
  double face_width_mm = 0;
  BevelForm form = BevelForm::herringbone;
  int hand = 1;                      ///< +1 right, -1 left; of the inner half, or of the gear when single
  double apex_cone_distance_mm = 0;  ///< R_J (herringbone) or R_ref (single; 0: R_m)
  double relief_half_width_mm = 0;   ///< turned groove about R_J, to root depth
  double addendum_mm = 0;
  double dedendum_mm = 0;
  double backlash_mm = 0;  ///< of the pair, circumferential at the outer pitch diameter
  // What the blank has beside its teeth: cylinders about its axis, 0: none. The tool must not meet them.
  double hub_diameter_mm = 0, hub_length_mm = 0;      ///< behind the root of the large end
  double shaft_diameter_mm = 0, shaft_length_mm = 0;  ///< from the root of the small end towards the apex and beyond
  std::optional<FingerCutterData> mill = {};          ///< whose envelope the walls are, where no finger mill cuts them
  std::vector<modification::Modification> modifications = {};  ///< of the flanks: `right` is wall U; zones are halves
};

}  // namespace toothpath::bevel_gear
