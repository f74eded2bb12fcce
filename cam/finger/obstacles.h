// What else of the workpiece a finger mill can meet: the blank above its teeth, the hub behind it and the shaft before
// it.
//
// Both sides are sets of circles, so the gap along a direction n is exact: n . tool - n . part over the rims. Any
// direction gives a lower bound of the distance of the convex hulls, hence of the bodies; the best one is searched.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/tool/body.h"
#include "cam/tool/profile.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

/// A convex body of revolution about the gear axis, by its rims: (r, z) [mm], gear frame.
struct CoaxialBody {
  const char* name = "";  ///< "blank", "hub", "shaft"
  std::vector<Vec2> rims;
};
/// Hub and shaft of the gear; empty where it has none.
[[nodiscard]] std::vector<CoaxialBody> bodies_beside_teeth(const bevel_gear::BevelGear& gear);

/// The blank: teeth up to the face cone and the ring below them.
[[nodiscard]] CoaxialBody blank_body(const bevel_gear::BevelGear& gear);

/// A convex hull of one body of the tool, by its rims: (height above the tip, radius) [mm].
struct ToolHull {
  tool::Body body = tool::Body::flute;  ///< or shank, holder
  std::vector<Vec2> rims;
};
/// Flute, shank and holder of a profile of lines (`finger_profile`); parts that it lacks are left out.
[[nodiscard]] std::vector<ToolHull> tool_hulls(const tool::Profile& tool);
/// A sag for profiles of which only hulls are made [mm]: the hull of a hollow flank needs no more than one chord.
inline constexpr double kOneChord = 1e9;

/// Where a tool body and a body about the gear axis come nearest.
struct ObstacleGap {
  double gap = 0;             ///< never above the true one [mm]; negative: how far they must be moved apart at least
  Vec3 place = Vec3::Zero();  ///< on the body of the gear
};
/// Over a whole motion. Between the ends the tip is straight and the axis the normalised blend; deviations of the
/// motion are taken off. Gaps below 0.5 mm are true to 1e-5 mm where the axis does not turn; larger ones may be told
/// too small.
[[nodiscard]] ObstacleGap nearest_obstacle(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m);
[[nodiscard]] inline double body_gap(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m) {
  return nearest_obstacle(tool, body, m).gap;
}

/// Largest n . p of the blank (teeth and the ring below them) in direction n.
[[nodiscard]] double blank_support(const bevel_gear::BevelGear& gear, const Vec3& n);
/// The place on the face cone of the blank that reaches farthest in direction n; where a whole line does, the one next
/// to `near`.
[[nodiscard]] Vec3 blank_place(const bevel_gear::BevelGear& gear, const Vec3& n, const Vec3& near);

}  // namespace toothpath::finger
