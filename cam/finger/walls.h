// Points of the exact walls of tooth space 0, and what a program leaves on them or cuts out of them: measured against
// the solid cutter along every motion, and bounded by the distance of the wall paths from the motions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cam/finger/ridge.h"
#include "cam/finger/tool.h"
#include "cam/proof/verification.h"

namespace toothpath::finger {

struct WallPoint {
  int half = 0, wall = 0, row = 0,
      column = 0;  ///< row -1: the wall has no such point; its place is that of the point before
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();  ///< blank frame; out of the material
};

/// Grid of every wall of every half: equal steps of the profile parameter from the fillet to h_a, equal steps along the
/// face up to both ends. Wall by wall, row-major.
[[nodiscard]] std::vector<WallPoint> wall_points(const bevel_gear::BevelGear& gear, int rows, int columns);

/// Distance of every point from what has been cut, after each operation [mm]: > 0 material left, < 0 cut too deep.
struct WallExcess {
  std::vector<std::vector<double>> after;        ///< one row an operation
  std::vector<const path::ToolMotion*> deepest;  ///< the motion that comes nearest to the point; null: none
};
/// @param by_operation  cutting motions in tooth space 0, in the order of the job
/// @param most_mm  stands for everything that is thicker, where no motion comes near
[[nodiscard]] WallExcess measure_walls(std::span<const WallPoint> points,
                                       std::span<const std::vector<FingerCut>> by_operation, double most_mm);

/// Extremes and histogram of one field; bound_mm is left at the largest measured value.
[[nodiscard]] proof::ExcessResult summary_of(std::span<const WallPoint> points, std::span<const double> excess,
                                             int operation);

/// One grid a wall for the report.
[[nodiscard]] std::vector<proof::SurfaceGrid> wall_grids(std::span<const WallPoint> points, const WallExcess& excess,
                                                         int rows, int columns);

/// Largest distance of the nominal wall paths from the motions [mm]: no more can stand on a wall anywhere. Large where
/// a part of a path is not run at all.
[[nodiscard]] double left_bound(const bevel_gear::BevelGear& gear, const FingerTool& tool,
                                std::span<const FingerCut> cuts);

}  // namespace toothpath::finger
