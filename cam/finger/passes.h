// Where the centre of a finger mill goes in one tooth space: passes as smooth pieces of crown-plane curves, before they
// are cut into blocks. Ends and corners as docs/bevel_gear.md, section 6, says.
//
// Roughing: the middle of each half and the fill passes that the allowed ridge asks for, at even shares of the room
// between both wall paths, which they never leave. Finishing: both walls. In a herringbone the wall whose corner is
// convex is one pass through both halves, closed by the arc of radius r_0 about the corner of the trace; the other wall
// is two passes, which stop where the offset curves of the halves cross.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

/// A smooth piece of a centre path over t = 0 .. 1, in the direction of growing R_c.
struct CentrePiece {
  int half = 0;  ///< 0 inner, 1 outer; the arc of a corner counts as outer
  std::function<bevel_gear::CutterCentre<double>(double)> at;
};

struct CentrePass {
  std::string name;      ///< "middle", "fill 0.33", "wall L", "wall U"
  bool outward = false;  ///< the cutter runs towards growing R_c
  std::vector<CentrePiece> pieces;
};

/// Passes of finger roughing, outer half first.
/// @param ridge_mm highest ridge that may stay on the root
/// @param predicted_mm  gets the highest ridge between the passes and the walls, not below the true one
[[nodiscard]] std::vector<CentrePass> roughing_passes(const bevel_gear::BevelGear& gear, double ridge_mm,
                                                      double& predicted_mm);

/// Both walls. `climb`: material lies to the right of the feed, seen from the shank.
[[nodiscard]] std::vector<CentrePass> wall_passes(const bevel_gear::BevelGear& gear, bool climb);

/// The arc that closes the gap of the convex corner of a herringbone, t = 0 at the inner half. The gear is a
/// herringbone.
[[nodiscard]] bevel_gear::CutterCentre<double> corner_arc(const bevel_gear::BevelGear& gear, double t);

/// Distance of two centres in the crown plane, mm.
[[nodiscard]] double crown_distance(const bevel_gear::CutterCentre<double>& a,
                                    const bevel_gear::CutterCentre<double>& b);

/// Height above the root cone, along the normal of the pitch cone, of the ridge left between two positions a lateral
/// distance `gap` apart at cone distance R_c, mm.
[[nodiscard]] double finger_ridge(const bevel_gear::BevelGear& gear, double R_c, double gap);
/// The other way: largest lateral distance for a ridge, mm.
[[nodiscard]] double finger_gap(const bevel_gear::BevelGear& gear, double R_c, double ridge);

}  // namespace toothpath::finger
