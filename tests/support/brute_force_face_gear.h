// Is a point of the gear blank cut away? Answered by sweeping the solid shaper past the point, without any equation of
// meshing. Shares no formula with geometry/: it starts from the parameters alone.
#pragma once

#include <cmath>

#include "geometry/base/vec.h"
#include "geometry/face_gear/parameters.h"

namespace toothpath::test {

class BruteForceFaceGear {
 public:
  BruteForceFaceGear(const face_gear::FaceGearParameters& gear, double helix_angle_rad);

  /// Distance of a point to the shaper at roll angle phi in the shaper's transverse plane, positive outside the shaper.
  /// Exact near the involute and the rounding; elsewhere of the right sign.
  [[nodiscard]] double clearance(const Vec3& point, double phi) const;

  /// Least clearance over the whole motion: 0 on the finished surface, > 0 in the remaining material, < 0 where cut.
  /// Times `cos_base_helix()` it is the normal distance of a point to the involute flank.
  /// @param enough ends the search with the first value found at or below it
  [[nodiscard]] double least_clearance(const Vec3& point, double enough = -INFINITY) const;

  [[nodiscard]] double cos_base_helix() const { return cos_base_helix_; }

 private:
  int shaper_teeth_;
  double ratio_, offset_, sin_gamma_, cos_gamma_, reference_;
  double r_b_, r_a_, rho_, twist_, half_space_, cos_base_helix_;
  double centre_radius_, centre_angle_, rounding_opening_;
};

}  // namespace toothpath::test
