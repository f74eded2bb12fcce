// How deep one pose of a finger mill goes into the finished gear, from the place of its centre, and how many poses of a
// motion must be judged so that nothing between them is worse than a stated share. Derivation: docs/bevel_gear.md,
// section 9.
#pragma once

#include <string>

#include "cam/finger/tool.h"

namespace toothpath::finger {

/// mm: what the centre may do between two poses at which it is judged.
inline constexpr double kBetweenPoses = 5e-5;

struct PoseDepth {
  double depth = -1e9;  ///< > 0: into the part, never below the true depth [mm]
  std::string patch;    ///< "wall L", "wall U", "root" or "tip"
  double root = 0;      ///< of the tip below the root cone
  double tilt = 0;      ///< of the axis against the normal of the pitch cone, rad
};
/// Of a pose in tooth space 0.
[[nodiscard]] PoseDepth pose_depth(const bevel_gear::BevelGear& gear, const FingerTool& tool, const Vec3& tip,
                                   const Vec3& axis);

/// Number of intervals at whose ends a motion is judged, and what may happen between them.
struct PoseSampling {
  int intervals = 1;
  double extra_mm = 0;
};
/// The centre's distance from a wall path bends by no more than both curvatures together; deviations of the motion are
/// in it.
[[nodiscard]] PoseSampling pose_sampling(const bevel_gear::BevelGear& gear, const FingerTool& tool,
                                         const path::ToolMotion& m);

/// Name of wall 0 (L) or 1 (U).
[[nodiscard]] std::string wall_name(int wall);

}  // namespace toothpath::finger
