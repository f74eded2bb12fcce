// A tool axis that the job prescribes by keys along the teeth: read as one smooth curve, and proven place by place.
//
// A key is a lean q = (tan outwards, tan aside) from the normal of the pitch surface, u = (up + q_1 outwards + q_2
// aside) / | |, at a radius of the ball centre about the gear axis. Between two keys q is a cubic in the radius with
// limited slopes: it never leaves the box of its two keys, its derivative is continuous, and it is 0 at the first and
// at the last key, beyond which q stays. Straight lines of q are great circles, so that two keys alone make the axis
// turn on the great circle through both.
#pragma once

#include "cam/ball/tool_orientation.h"
#include "cam/path/operation.h"

namespace toothpath::ball {

/// The curve through the keys.
class PrescribedLean {
 public:
  /// @param keys  at least one, radii ascending
  explicit PrescribedLean(const std::vector<path::ToolAxisKey>& keys);
  /// (tan outwards, tan aside) with the ball centre at this radius, mm.
  [[nodiscard]] Vec2 at(double radius_mm) const;

 private:
  std::vector<double> radius_;
  std::vector<Vec2> lean_, slope_;  ///< slope: per mm
};

/// Axes for all passes of one zone from the keys of the operation; inserts points into the passes where the axis turns.
///
/// Refuses where shank or holder keep less than `clearance_mm`, the flute would cut, or the draft is less than
/// `least_draft`: the worst place, with the body, its gap or depth, and the limit. Looked at are all records and places
/// between them at most 0.3 mm apart. The ball stays on its pass. How near the axis comes to the pole of a machine is
/// not asked here: that is for the post.
[[nodiscard]] Expected<Orientation, OrientationRefusal> prescribe_axes(
    const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone, const tool::ToolAssembly& tool,
    const path::MillingOperation& operation, OrientationOptions options, std::vector<BallPass>& passes);

}  // namespace toothpath::ball
