// The bodies of a tool assembly as frustums about its axis, and their distance to points and cells of the part.
#pragma once

#include <vector>

#include "cam/cutter.h"
#include "cam/gear_distance.h"

namespace toothpath {

/// A truncated cone about the tool axis. Heights from the tip, mm.
struct Frustum {
  double from = 0, to = 0;              ///< heights
  double radius_from = 0, radius_to = 0;
  const char* name = "";                ///< "flute", "shank", "holder"
};

/// Shank and holder of a ball mill, from below. The flute (same radius as the ball) is not among them.
[[nodiscard]] std::vector<Frustum> shank_and_holder(const ToolAssembly& tool);

/// Distance from a point to a solid frustum with its tip at `tip` and unit axis `axis`; 0 inside.
[[nodiscard]] double distance_to_frustum(const Vec3& point, const Frustum& f, const Vec3& tip, const Vec3& axis);

/// Least distance between a triangle and a frustum, from below, or `best` where that is less: the triangle is halved until its size is
/// `resolution` or can matter no more. A triangle that cuts in: -resolution.
[[nodiscard]] double triangle_gap(const Vec3& a, const Vec3& b, const Vec3& c, const Frustum& f, const Vec3& tip, const Vec3& axis, double best,
                                  double resolution, int depth);

/// Lowest z of a frustum.
[[nodiscard]] double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis);

/// Least gap between a frustum and the finished teeth, proven to `resolution_mm` from below; gaps above `enough` are
/// returned as `enough`. All teeth are seen.
struct BodyGap {
  double gap = 0;
  int zone = 0;
  Vec3 place = Vec3::Zero();
};
[[nodiscard]] BodyGap body_gap(const GearDistance& part, const Frustum& f, const Vec3& tip, const Vec3& axis, double enough,
                               double resolution_mm);

}  // namespace toothpath
