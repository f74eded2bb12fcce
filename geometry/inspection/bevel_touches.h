// A bevel gear under a probe that comes as its finger mill does, upright on the pitch cone.
#pragma once

#include "geometry/bevel_gear/gear.h"
#include "geometry/inspection/touches.h"

namespace toothpath::inspection {

/// Walls half-way between the end of the straight of the mill's profile and the tip: in the middle of each half of a
/// herringbone, at a quarter and three quarters of the face of a single hand. Of the blank its face cone at a quarter
/// and three quarters of the whole face. `side` of a touch is sigma of its wall, `zone` the half.
class TouchedBevelGear : public TouchedPart {
 public:
  /// @param gear  must outlive this
  explicit TouchedBevelGear(const bevel_gear::BevelGear& gear) : gear_(gear) {}

  [[nodiscard]] int teeth() const override { return gear_.parameters().teeth; }
  [[nodiscard]] PartReach reach() const override;
  [[nodiscard]] Result<std::vector<Touch>> flank_places(int spaces) const override;
  [[nodiscard]] Result<std::vector<Touch>> blank_places(int spaces) const override;
  [[nodiscard]] std::optional<double> distance(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double flank(const Touch& touch, int side, const Vec3& x) const override;
  [[nodiscard]] double above_root(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double below_tops(const Touch& touch, const Vec3& x) const override;

 private:
  [[nodiscard]] bevel_gear::ConePoint on_cone(const Vec3& x) const;
  [[nodiscard]] Vec3 place(double ell, double height, double azimuth) const;
  [[nodiscard]] std::optional<double> wall_distance(int half, int sigma, const Vec3& x) const;
  const bevel_gear::BevelGear& gear_;
};

}  // namespace toothpath::inspection
