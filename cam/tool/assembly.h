// A tool assembly: cutter, neck or shank, holder. Lengths mm, measured along the axis from the tip.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cam/tool/radius_law.h"

namespace toothpath::tool {

/// What a cutter is: cam/tool/cutters.h has a line for each.
enum class CutterType { ball_end_mill, tapered_ball_end_mill, flat_end_mill, bull_nose_end_mill, finger_mill };

/// A conical or cylindrical piece of a holder, from the tip side.
struct HolderSegment {
  double lower_diameter_mm = 0, upper_diameter_mm = 0, height_mm = 0;
};

struct ToolAssembly {
  int number = 0;                 ///< T word
  std::string name, holder_name;  ///< as the shop calls them; empty: not said
  CutterType type = CutterType::ball_end_mill;
  double diameter_mm = 0;      ///< of the ball; of a flat or bull nose mill that of the cutter; a finger mill has none
  double flute_length_mm = 0;  ///< tip to the end of the cutting part; shank above it
  double shank_diameter_mm = 0;
  double length_mm = 0;  ///< gauge line to tip
  std::vector<HolderSegment> holder;
  double stick_out_mm = 0;          ///< tip to the lower face of the holder
  int teeth = 2;                    ///< cutting edges
  double check_tolerance_mm = 0;    ///< how far its length may be off where it is checked; 0: not stated
  double life_min = 0;              ///< minutes of cutting that it lasts; 0: not stated
  std::vector<int> sisters;         ///< T of tools of the same form that go on when it is used up, in their order
  int sister_of = 0;                ///< T of the tool in whose place it goes on; 0: it is no sister
  double half_angle_rad = 0;        ///< tapered: between axis and side
  double corner_radius_mm = 0;      ///< bull nose
  std::optional<double> helix_rad;  ///< of the flutes, where the job says it
  std::optional<double> form_error_mm, half_angle_error_rad,
      run_out_mm;                         ///< stated: of the form, the angle, total reading
  std::optional<MeridianError> meridian;  ///< measured: error of rho along t
  // Finger mill only.
  double module_mm = 0;          ///< m_nj
  double tip_radius_mm = 0;      ///< r_t
  double rack_depth_mm = 0;      ///< h_C
  double profile_height_mm = 0;  ///< x_D

  [[nodiscard]] double radius_mm() const { return diameter_mm / 2; }
};

}  // namespace toothpath::tool
