// The deepest place that one motion of a finger mill cuts into the finished walls: searched on the walls themselves,
// not on a grid.
#pragma once

#include "cam/finger/tool.h"

namespace toothpath::finger {

struct DeepestCut {
  double depth_mm = 0;        ///< of a wall point inside the cutter; negative: the least gap that was found
  Vec3 point = Vec3::Zero();  ///< on the wall, tooth space 0
  int half = 0, wall = 0;
};

/// @param gear  made with the finishing mill: its walls are the finished ones, up to the ends of the face and the edges
/// of the groove
/// @param m     in tooth space 0
/// Depths up to 0.1 mm are true to 2e-5 mm; nothing nearer than 1 mm to a wall: a depth below -1.
[[nodiscard]] DeepestCut deepest_cut(const bevel_gear::BevelGear& gear, const FingerTool& tool,
                                     const path::ToolMotion& m);

}  // namespace toothpath::finger
