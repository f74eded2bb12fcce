// How large a ball may be that still touches all of the finished surface.
#pragma once

#include "cam/analytic/gear_distance.h"

namespace toothpath::cut {

/// Where a ball of more than `radius_mm` can no longer touch the surface without cutting elsewhere.
struct LargestBall {
  double radius_mm = 0;  ///< 0: no ball above 1 um reaches everything, the fillet has a sharp corner
  int zone = 0;
  tooth_space::Piece piece = tooth_space::Piece::root;
  Vec3 place = Vec3::Zero();  ///< on the surface, gear frame
};

/// The largest ball that touches every place of every tooth space and cuts nothing: at each place of a grid over the
/// exact surface the ball in its normal is limited by the greatest concave curvature there and by everything else that
/// it meets; the tightest place of the grid is then followed to its bottom. A ball larger than `most_mm` (radius; at
/// most the reach of `part`) is not looked for: then that is returned. Accuracy: 1e-4 mm where smooth walls decide,
/// against dense sampling (unreached_test).
[[nodiscard]] LargestBall largest_reaching_ball(const analytic::GearDistance& part, double most_mm);

/// The greatest concave principal curvature of a patch [1/mm], > 0; 0 where it is flat or convex in every direction.
[[nodiscard]] double concave_curvature(const tooth_space::PatchPoint& at);

}  // namespace toothpath::cut
