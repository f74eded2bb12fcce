// Ridges that finger mill passes leave on the root of a bevel gear, searched between the lines under both wall paths.
#pragma once

#include <span>

#include "cam/finger/tool.h"

namespace toothpath::finger {

/// Ridges between the passes, above the root cone along the normal of the pitch cone; outside the relief groove.
struct RidgeResult {
  double requested_mm = 0;                       ///< smallest ridge that an operation asks for; 0: none asks
  double reached_mm = 0;                         ///< highest, after all operations
  double least_mm = 0;                           ///< of the highest of each station along the face the lowest
  double cone_distance_mm = 0, azimuth_rad = 0;  ///< where
  std::size_t points = 0;
};

/// A cutting motion in tooth space 0 with its tool.
struct FingerCut {
  const path::ToolMotion* motion = nullptr;
  const FingerTool* tool = nullptr;
};

/// Highest ridge that these motions leave.
/// @param reference  a tool whose own walls are the finished ones: the fillets begin at its paths
/// @param columns, rows_across  stations along the face of the gear, points across the space on each; kinks are
/// narrowed down
[[nodiscard]] RidgeResult highest_ridge(const bevel_gear::BevelGear& gear, std::span<const FingerCut> cuts,
                                        const FingerTool& reference, int columns, int rows_across);

}  // namespace toothpath::finger
