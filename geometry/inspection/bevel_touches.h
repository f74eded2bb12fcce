// A bevel gear under a probe that comes as its finger mill does, upright on the pitch cone.
#pragma once

#include <memory>

#include "geometry/bevel_gear/part.h"
#include "geometry/inspection/tooth_touches.h"

namespace toothpath::inspection {

/// Walls half-way between the end of the straight of the mill's profile and the tip: in the middle of each half of a
/// herringbone, at a quarter and three quarters of the face of a single hand. Of the blank its face cone at a quarter
/// and three quarters of the whole face. `side` of a touch is sigma of its wall, `zone` the half.
class TouchedBevelGear final : public TouchedTeeth {
 public:
  explicit TouchedBevelGear(std::shared_ptr<const bevel_gear::BevelPart> part);

  /// Hub and shaft, too.
  [[nodiscard]] PartReach reach() const override;
  [[nodiscard]] Result<std::vector<Touch>> flank_places(int spaces) const override;
  [[nodiscard]] Result<std::vector<Touch>> blank_places(int spaces) const override;
  /// Up to where the rounding of the root begins.
  [[nodiscard]] double above_root(const Touch& touch, const Vec3& x) const override;

 private:
  [[nodiscard]] Vec3 place(double ell, double height, double azimuth) const;

  std::shared_ptr<const bevel_gear::BevelPart> part_;
  const bevel_gear::BevelGear& gear_;
};

}  // namespace toothpath::inspection
