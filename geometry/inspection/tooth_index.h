// Pitch and run-out of a measured gear, from where each flank stands (words and signs of ISO 17485).
#pragma once

#include <vector>

#include "geometry/base/result.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::inspection {

/// How far the middle of one flank of one tooth stands off the shape that all teeth have in common.
struct ToothPlace {
  int zone = 0, side = 1, tooth = 0;
  double off_mm = 0;  ///< along the normal, positive: material left; the mean over all teeth need not be 0
};

/// Pitch of the flanks of one side of one ring: arcs in planes across the axis at the middle radius of the ring.
struct PitchDeviation {
  int zone = 0, side = 1;
  double radius_mm = 0;
  int teeth = 0;          ///< with measured flanks
  int pairs = 0;          ///< of neighbours among them
  double single_mm = 0;   ///< f_p: largest deviation of a pitch, its size; 0 without pairs
  int single_tooth = 0;   ///< between this tooth and the next
  double total_mm = 0;    ///< F_p: largest less least index deviation over the measured teeth
  bool complete = false;  ///< every tooth was measured: otherwise F_p may be larger
};

/// Run-out of one ring: how far a ball in the tooth spaces, touching both flanks at half their height and at the middle
/// radius, stands up and down along the normal of the tip surface.
struct RunOut {
  int zone = 0;
  double radius_mm = 0;
  int spaces = 0;         ///< with both flanks measured
  double run_out_mm = 0;  ///< F_r: highest less lowest
  bool complete = false;
};

struct IndexOfTeeth {
  std::vector<PitchDeviation> pitch;  ///< where two teeth or more were measured
  std::vector<RunOut> run_out;        ///< where two spaces or more were measured
};

/// Errors: those of `inspection_grid`.
[[nodiscard]] Result<IndexOfTeeth> index_of_teeth(const tooth_space::ToothedSolid& gear,
                                                  const std::vector<ToothPlace>& places);

}  // namespace toothpath::inspection
