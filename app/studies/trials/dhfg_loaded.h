// The nine trials under load: what the elastic pair of each does over a pitch.
#pragma once

#include <string>
#include <vector>

#include "app/report/page/report_page.h"
#include "geometry/face_gear/gear.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::trials {

struct DhfgTrial;

/// Bricks and positions of a study.
struct LoadedEffort {
  int across = 4, flank = 6, face = 8, positions = 24;
};

inline constexpr double kMicro = 1e6, kUm = 1e3;  ///< in a rad, in a mm
/// Coefficient of friction of the article's finite elements.
inline constexpr double kArticleFriction = 0.08;

struct Range {
  double least = 1e300, most = -1e300, mean = 0;
};

/// Pinion held at its exact place, but where it says floating.
struct LoadedTrial {
  std::string refusal;  ///< not empty: there are no numbers
  double normal_n = 0, single_axial_n = 0;
  Range approach_mm, stiffness, line_mm, outer_share;
  Range remainder;  ///< |axial force|, part of that of one helix
  int least_pairs = 0, most_pairs = 0;
  double mean_pairs = 0;
  int stiffness_falls = 0;                                             ///< how often a pitch it falls and rises again
  double error_rad = 0, floating_error_rad = 0, floating_axial_n = 0;  ///< peak to peak; largest
  double pressure = 0, end_pressure = 0;                               ///< MPa
  double share_per_um = 0;                                             ///< change of the share with the pinion's place
  /// What friction of kArticleFriction would add along the pinion, N, and to the gear's torque, part of it: a bound.
  double friction_axial_n = 0, friction_torque = 0;
};
/// @param torque_nmm  on the gear
[[nodiscard]] LoadedTrial load_trial(const face_gear::FaceGear& gear, double torque_nmm, const LoadedEffort& effort);

/// One gear with coarser and finer bricks and pieces of lines.
struct EffortRow {
  std::string name;
  LoadedEffort effort;
  double segment_mm = 0, rim_mm = 0;
  int row_teeth = 5;
  LoadedTrial found;
  double seconds = 0;  ///< run time; 0: nobody measured it
};
/// Those that are tried, with nothing found yet; two of them with `quick`.
[[nodiscard]] std::vector<EffortRow> effort_rows(double module_mm, bool quick);
/// Fills in what is found, and its run time.
void load_effort(const face_gear::FaceGear& gear, double torque_nmm, EffortRow& row);

[[nodiscard]] page::PageTable loaded_trials_table(const std::vector<DhfgTrial>& trials);
/// All trials with halves of one width: what is left of their differences when the face is the same.
struct EqualHalves {
  double half_face_mm = 0;
  std::vector<LoadedTrial> trials;
};
[[nodiscard]] page::PageTable equal_halves_table(const EqualHalves& equal);
[[nodiscard]] page::PageTable effort_table(const std::vector<EffortRow>& rows, int trial);

}  // namespace toothpath::trials
