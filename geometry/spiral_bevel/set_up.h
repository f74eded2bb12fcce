// From the settings of a generator to the kernel of a tooth space: where on its roll each flank is cut, and how the
// flanks are turned into space 0.
#pragma once

#include <string>

#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/spiral_bevel/cutter_kernel.h"

namespace toothpath::spiral_bevel {

/// Index of the cut that makes a flank, 0: concave. Every gear that is asked has one for each.
[[nodiscard]] std::size_t cut_of(const SpiralBevelParameters& gear, std::size_t flank);
/// "cut[1].": where the settings of a flank stand in a job.
[[nodiscard]] std::string cut_key(const SpiralBevelParameters& gear, std::size_t flank, const char* name);

/// Refused modified roll of a flank: at that roll the work stands still or turns back against the cradle.
[[nodiscard]] Refusal stands_still(const SpiralBevelParameters& gear, std::size_t flank, const CutFlank& f,
                                   double roll_rad, double cone_distance_mm);

/// z of the apex of the root cone of a cut without tilt.
[[nodiscard]] double root_apex_z(const Cut& cut);
/// Where the root cone of a cut, or a cone of half angle `angle` with its apex at z, lies in the chart: h at s.
[[nodiscard]] double cone_height(const SpiralBevelParameters& gear, double angle_rad, double apex_z, double s);
/// What two cuts leave of the pitch circle for a space at the mean cone distance. mm
[[nodiscard]] double asked_space_width(const SpiralBevelParameters& gear);

struct SetUp {
  CutterKernel kernel;
  double space_width_mm = 0;  ///< arc on the pitch circle at the mean cone distance
};
/// A flank is followed along the face by its roll, or by the place on the circles of its blade where the roll would
/// grow unevenly: at small spiral angles and on steep blades its contact lines run along these circles, and the roll
/// turns back. That needs an even roll and no tilt. Refused: a cutter that does not pass the middle of the root, a
/// flank that does not reach the pitch cone there.
/// @param by_rolls  never by circles
[[nodiscard]] Expected<SetUp, Refusal> set_up(const SpiralBevelParameters& gear, bool by_rolls = false);

}  // namespace toothpath::spiral_bevel
