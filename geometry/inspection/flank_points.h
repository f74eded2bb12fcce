// Measured points put on the flanks they belong to: ring, tooth, side, parameters and deviation of each.
#pragma once

#include <vector>

#include "geometry/inspection/point_file.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::inspection {

/// A point that lies farther than this from every flank belongs to none, mm.
inline constexpr double kFarthestFromFlank = 0.5;
/// A foot may lie beyond the ends of a flank by so much, mm: a burr, a chamfer, a frame that is a little off.
inline constexpr double kBeyondFlank = 0.05;

/// A measured point against the flank of its tooth; the foot is that of space 0.
struct FlankPoint {
  int zone = 0;              ///< of the job
  int side = 1;              ///< +1 or -1
  int tooth = 0;             ///< 0 .. teeth - 1; space k lies between flank +1 of tooth k and flank -1 of tooth k + 1
  double theta = 0, B = 0;   ///< of the foot: its (u, v)
  Vec3 foot = Vec3::Zero();  ///< in space 0
  double deviation_mm = 0;   ///< distance from the exact flank, positive: material left
};

/// One for each point of the file, in its order. The distance is that to the nearest place of the exact flank.
/// @param ball_radius_mm  > 0: the points are centres of a probe's ball of that radius, which touched the flank
/// Refused, at the place of the point: one that lies on no flank, or on two alike. Where all points are off in the same
/// way, the message says so: another unit, centres of a ball.
[[nodiscard]] Result<std::vector<FlankPoint>> place_on_flanks(const tooth_space::ToothedSolid& gear,
                                                              const PointFile& measured, double ball_radius_mm = 0);

}  // namespace toothpath::inspection
