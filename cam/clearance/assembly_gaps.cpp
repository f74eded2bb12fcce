#include "cam/clearance/assembly_gaps.h"

#include <algorithm>
#include <cmath>

namespace toothpath::clearance {
namespace {

constexpr std::size_t kPoseWindow = 16;   // poses that share their candidates
constexpr double kPoseWindowReach = 1.6;  // mm
constexpr double kMostAhead = 16;         // mm
constexpr double kLeastAhead = 0.25;

/// Bound of the way of any point of a body between two poses: `arm` is the distance of its farthest point from the tip.
double motion_between(const ToolPose& a, const ToolPose& b, double arm) {
  return (a.tip - b.tip).norm() + arm * (a.axis - b.axis).norm();
}

double arm_of(const tool::Frustum& f) {
  return std::hypot(std::max(std::abs(f.from), std::abs(f.to)), std::max(f.radius_from, f.radius_to));
}

}  // namespace

MeshAssembly::MeshAssembly(const MeshDistance& mesh, const tool::ToolAssembly& tool, double within_mm)
    : mesh_(mesh),
      radius_(tool.radius_mm()),
      height_(std::max(0.0, tool.flute_length_mm - tool.radius_mm())),
      within_(within_mm),
      frustums_(tool::shank_and_holder(tool)),
      free_(frustums_.size()),
      beside_(64) {}

/// Is the body inside the solid? It has not changed sides unless its way was as long as the room on both ends of it.
bool MeshAssembly::side(Free& f, const ToolPose& pose, double gap, double motion, const Vec3& inner) {
  const bool known = f.last_gap > 0 && gap > 0 && motion < f.last_gap + gap;
  if (!known) f.inside = gap > 0 && mesh_.inside(inner);
  f.last = pose;
  f.last_gap = gap;
  return f.inside;
}

double MeshAssembly::other_body(std::size_t index, const ToolPose& pose) {
  const tool::Frustum& body = frustums_[index];
  Free& f = free_[index];
  const double arm = arm_of(body);
  double gap = within_;
  if (f.gap < 0 || f.gap - motion_between(f.pose, pose, arm) < within_) {
    ++queries_;
    const double limit = within_ + f.ahead;
    f.pose = pose;
    f.gap = mesh_.frustum_bound(body, pose.tip, pose.axis, limit);
    f.ahead = f.gap >= limit ? std::min(2 * f.ahead, kMostAhead) : std::max(kLeastAhead, f.gap - within_);
    if (f.gap < within_) f.gap = mesh_.to_frustum(body, pose.tip, pose.axis, within_ + kLeastAhead).distance;
    gap = std::min(f.gap, within_);
  }
  const Vec3 middle = pose.tip + 0.5 * (body.from + body.to) * pose.axis;
  if (side(f, pose, gap, motion_between(f.last, pose, arm), middle)) {
    f.gap = -1;
    return -INFINITY;
  }
  return gap;
}

void MeshAssembly::cutting_part(std::span<const ToolPose> poses, std::span<double> gaps) {
  const MeshKernels& kernels = mesh_kernels();
  const TreeView tree = mesh_.view();
  const Vec3& origin = mesh_.tree().origin();
  const double within = radius_ + within_, arm = radius_ + height_;
  const auto centre = [&](std::size_t k) -> Vec3 { return poses[k].tip + radius_ * poses[k].axis - origin; };
  for (std::size_t from = 0, to = 0; from < poses.size(); from = to) {
    to = from + 1;
    while (to < poses.size() && to - from < kPoseWindow &&
           motion_between(poses[from], poses[to], arm) < kPoseWindowReach)
      ++to;
    const ToolPose& middle = poses[from + (to - from) / 2];
    const Vec3 c = centre(from + (to - from) / 2);
    double half = 0;
    for (std::size_t k = from; k < to; ++k) half = std::max(half, motion_between(middle, poses[k], arm));
    near_ = kernels.nearest(tree, c.data(), (within + half) * (within + half), near_);
    const double reach = std::min(near_.block < 0 ? INFINITY : std::sqrt(near_.squared) + 2 * half, within + half);
    window_.gather(tree, {{c.x(), c.y(), c.z()}, {middle.axis.x(), middle.axis.y(), middle.axis.z()}, height_},
                   reach + 1e-6);
    ++queries_;
    for (std::size_t k = from; k < to; ++k) {
      const Vec3 p = centre(k);
      double d = within;
      if (window_.size() > 0) {
        const TriangleHit hit =
            kernels.nearest_in(tree, window_.groups(), window_.size(), p.data(), within * within, near_);
        double best2 = within * within;
        if (hit.block >= 0) {
          near_ = hit;
          d = std::min(d, (nearest_on_triangle(p, corners_of(tree.blocks[hit.block], hit.lane)) - p).norm());
          best2 = d * d;
        }
        // The flute: a triangle whose nearest point lies below the ball's centre is farther from all that is above it.
        const Vec3& axis = poses[k].axis;
        const CapsuleView flute{{p.x(), p.y(), p.z()}, {axis.x(), axis.y(), axis.z()}, height_};
        if (height_ > 0) {
          std::size_t count = kernels.beside_flute(tree, window_.groups(), window_.size(), flute, best2, beside_.data(),
                                                   beside_.size());
          if (count > beside_.size()) {
            beside_.resize(2 * count);
            count = kernels.beside_flute(tree, window_.groups(), window_.size(), flute, best2, beside_.data(),
                                         beside_.size());
          }
          for (std::size_t n = 0; n < count; ++n) {
            const TriangleCorners t = corners_of(tree.blocks[beside_[n] / kLanes], int(beside_[n] % kLanes));
            const Vec3 q = nearest_on_triangle(p, t) - p;
            if (q.dot(axis) <= 0) continue;
            Vec3 foot;
            d = std::min(d, std::sqrt(segment_to_triangle(p, axis, height_, t, foot)));
          }
        }
      }
      const Vec3 inner = poses[k].tip + (radius_ + 0.5 * height_) * poses[k].axis;
      gaps[k * bodies()] =
          side(cutter_, poses[k], d, motion_between(cutter_.last, poses[k], arm), inner) ? -INFINITY : d - radius_;
    }
  }
}

void MeshAssembly::gaps(std::span<const ToolPose> poses, std::span<double> gaps) {
  cutting_part(poses, gaps);
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t body = 0; body < free_.size(); ++body) gaps[k * bodies() + 1 + body] = other_body(body, poses[k]);
}

}  // namespace toothpath::clearance
