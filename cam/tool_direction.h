// Which fixed direction of the tool keeps shank and holder clear in one zone (3+2), and why.
#pragma once

#include <vector>

#include "cam/cutter.h"
#include "cam/finishing.h"
#include "cam/gear_distance.h"
#include "cam/verification.h"

namespace toothpath {

struct DirectionOptions {
  double clearance_mm = 0.05;  ///< least gap of shank and holder
  double least_draft = 0.01;   ///< least cosine between the tool axis and the normals of the surface: the ball, not its shank, cuts
};

/// Tries directions around the normal of the pitch surface (for a shaft angle of 90 deg: the gear axis), leaning by 0 to 40 deg to
/// eight sides, and takes the clear one that leans least. `fixed` is false and the axis meaningless when none is clear.
[[nodiscard]] DirectionChoice choose_direction(const GearDistance& part, int zone, const OffsetSheet& sheet,
                                               const std::vector<BallPass>& passes, const ToolAssembly& tool,
                                               const DirectionOptions& options);

}  // namespace toothpath
