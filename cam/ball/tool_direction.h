// Which fixed direction of the tool keeps shank and holder clear in one zone (3+2), and why.
#pragma once

#include <vector>

#include "cam/analytic/body_tree.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/finishing.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"

namespace toothpath::ball {

struct DirectionOptions {
  double clearance_mm = proof::ProofLimits{}.clearance_mm;  ///< least gap of shank and holder
  double room_mm = 0;  ///< kept beyond it: what words, control and proof may take of a gap
  double least_draft =
      0.01;  ///< least cosine between the tool axis and the normals of the surface: the ball, not its shank, cuts
  double allowance_mm = 0;  ///< that stays on all teeth: the flute leaves `path::kPlannedStock` of it
};

/// The frame in which directions are counted: `up` is the normal of the pitch surface in the middle of the zone (for a
/// shaft angle of 90 deg the gear axis), `outwards` along the teeth, `side` across them. Orthonormal, gear frame.
struct PitchFrame {
  Vec3 up = Vec3::UnitZ(), side = Vec3::UnitY(), outwards = Vec3::UnitX();
  /// Direction of a lean: tangents of its parts outwards and to the side.
  [[nodiscard]] Vec3 axis(double out, double aside) const { return (up + out * outwards + aside * side).normalized(); }
};
[[nodiscard]] PitchFrame pitch_frame(const analytic::GearDistance& part, int zone);

/// Tries directions around the normal of the pitch surface, leaning by 0 to 45 deg in steps of 5 deg to sides at most 7
/// deg of arc apart, then smaller and smaller steps around the best of them, and takes the clear one that leans least.
/// Where another ring of teeth stands beside the zone of a face gear, the gear axis comes first, and a direction in
/// which the flute cuts the teeth, or their allowance, is not clear. `fixed` is false and the axis meaningless when
/// none is clear; then the map holds every direction tried with the body in the way and its gap. A gap below 0 says by
/// how much the body would have to be slimmer and begin higher to cut nowhere (followed to -3 mm).
[[nodiscard]] proof::DirectionChoice choose_direction(const analytic::GearDistance& part,
                                                      const analytic::BodyTree& tree, int zone,
                                                      const tooth_space::OffsetSheet& sheet,
                                                      const std::vector<BallPass>& passes,
                                                      const tool::ToolAssembly& tool, const DirectionOptions& options);

}  // namespace toothpath::ball
