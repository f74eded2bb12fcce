// A face gear under a probe that comes along its axis.
#pragma once

#include "geometry/face_gear/gear.h"
#include "geometry/inspection/touches.h"

namespace toothpath::inspection {

/// Flanks at half their height: at a quarter and three quarters of the face, or in the middle of each of two zones. Of
/// the blank its top at the middle radius of the outer ring, and its rim below each of these places.
class TouchedFaceGear : public TouchedPart {
 public:
  /// @param gear  must outlive this
  explicit TouchedFaceGear(const face_gear::FaceGear& gear) : gear_(gear) {}

  [[nodiscard]] int teeth() const override { return gear_.parameters().teeth; }
  [[nodiscard]] PartReach reach() const override;
  [[nodiscard]] Result<std::vector<Touch>> flank_places(int spaces) const override;
  /// Refused: a shaft angle other than 90 deg, whose blank has no flat top.
  [[nodiscard]] Result<std::vector<Touch>> blank_places(int spaces) const override;
  [[nodiscard]] std::optional<double> distance(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double flank(const Touch& touch, int side, const Vec3& x) const override;
  [[nodiscard]] double above_root(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double below_tops(const Touch& touch, const Vec3& x) const override;

 private:
  [[nodiscard]] double turn_of(const Touch& touch, int side) const;
  const face_gear::FaceGear& gear_;
};

}  // namespace toothpath::inspection
