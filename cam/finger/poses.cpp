#include "cam/finger/poses.h"

#include <algorithm>
#include <cmath>

namespace toothpath::finger {
namespace {

constexpr int kMostSamples = 2000;

}  // namespace

std::string wall_name(int wall) { return wall == 0 ? "wall L" : "wall U"; }

PoseDepth pose_depth(const bevel_gear::BevelGear& gear, const FingerTool& tool, const Vec3& tip, const Vec3& axis) {
  PoseDepth out;
  const ConePose pose = cone_pose(gear, tip, axis, 0.0);
  const double lean = 2 * std::sin(0.5 * pose.tilt) * (tool.depth_mm + tool.solid.largest_radius());
  if (pose.lift - lean >= tool.depth_mm) {
    out.depth = tool.depth_mm + lean - pose.lift;
    out.patch = "tip";
    return out;
  }
  const bool over_blank =
      pose.R_c > gear.R_i() - tool.solid.largest_radius() && pose.R_c < gear.R_e() + tool.solid.largest_radius();
  const double dip = over_blank ? std::max(0.0, -pose.lift) : 0.0;
  out.root = dip;
  out.tilt = pose.tilt;
  for (int k = 0; k < 2; ++k) {
    const WallReference& wall = tool.walls[k];
    const double side = wall.side(pose.R_c, pose.theta);
    const double depth = (side < 0 ? -side * wall.leverage() + dip : -side + dip) + lean + tool.shape_mm;
    if (depth > out.depth) out.depth = depth, out.patch = wall_name(k);
  }
  if (over_blank && dip + lean > out.depth) out.depth = dip + lean, out.patch = "root";
  return out;
}

PoseSampling pose_sampling(const bevel_gear::BevelGear& gear, const FingerTool& tool, const path::ToolMotion& m) {
  const ConePose a = cone_pose(gear, m.tip_from, m.axis_from, 0.0), b = cone_pose(gear, m.tip_to, m.axis_to, 0.0);
  const double s = std::sin(0.5 * (b.theta - a.theta));
  const double shift = std::sqrt((b.R_c - a.R_c) * (b.R_c - a.R_c) + 4 * a.R_c * b.R_c * s * s);
  const double curvature = std::max(tool.walls[0].largest_curvature(), tool.walls[1].largest_curvature()) +
                           1 / (gear.R_i() * gear.sin_delta());
  PoseSampling out;
  out.intervals =
      std::clamp(static_cast<int>(std::ceil(shift * std::sqrt(curvature / (8 * kBetweenPoses)))), 1, kMostSamples);
  const double step = shift / out.intervals;
  out.extra_mm =
      curvature * step * step / 8 * tool.walls[0].leverage() + m.deviation_mm + m.axis_deviation * tool.depth_mm;
  return out;
}

}  // namespace toothpath::finger
