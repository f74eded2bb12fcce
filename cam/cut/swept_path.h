// What a ball has removed: the volume swept by a path of ball centres. Exact in double on candidates of a spatial
// index.
#pragma once

#include <vector>

#include "cam/analytic/spatial_index.h"

namespace toothpath::cut {

/// A straight move of a ball centre.
struct BallMove {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

class SweptPath {
 public:
  SweptPath(std::vector<BallMove> moves, double ball_radius_mm);

  /// min over the path of (distance to the ball centre - radius): > 0 material left at p, < 0 removed that deep.
  /// Values above `cap` are returned as `cap`. mm.
  [[nodiscard]] double excess(const Vec3& p, double cap) const;
  [[nodiscard]] double ball_radius_mm() const { return radius_; }
  [[nodiscard]] const std::vector<BallMove>& moves() const { return moves_; }

 private:
  std::vector<BallMove> moves_;
  double radius_;
  analytic::SpatialIndex index_;
};

}  // namespace toothpath::cut
