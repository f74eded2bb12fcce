// Any toothed gear under a probe that stands upright on its teeth.
#pragma once

#include <array>

#include "geometry/inspection/touches.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::inspection {

/// Flanks at half their height: at a quarter and three quarters of the face, or in the middle of each of several zones;
/// of cylindrical teeth the ends, too.
/// Of the blank its top (the tip surface with its stock) in the middle of the last ring, and the end of that ring below
/// each of these places. The stem of the probe stands in the direction of h over the middle of the space.
class TouchedTeeth : public TouchedPart {
 public:
  /// The spaces must outlive it. @param above_mm stock on the tip surface
  explicit TouchedTeeth(tooth_space::ToothedSolid gear, double above_mm = 0);

  [[nodiscard]] int teeth() const override { return gear_.teeth; }
  [[nodiscard]] PartReach reach() const override;
  [[nodiscard]] Result<std::vector<Touch>> flank_places(int spaces) const override;
  /// Refused: a top that is not square to the stem, which no cycle touches.
  [[nodiscard]] Result<std::vector<Touch>> blank_places(int spaces) const override;
  [[nodiscard]] std::optional<double> distance(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double flank(const Touch& touch, int side, const Vec3& x) const override;
  [[nodiscard]] double above_root(const Touch& touch, const Vec3& x) const override;
  [[nodiscard]] double below_tops(const Touch& touch, const Vec3& x) const override;

 private:
  /// A place of a flank of space 0, where a search begins.
  struct Start {
    double u = 0, v = 0;
    Vec3 p = Vec3::Zero();
  };
  [[nodiscard]] std::size_t ring_of(int zone) const;
  [[nodiscard]] Vec3 up_at(const Vec3& outwards) const;
  [[nodiscard]] Vec3 placed(double s, double h, const Vec3& outwards) const;
  [[nodiscard]] double top_at(std::size_t ring, double s) const { return gear_.rings[ring].space->tip(s) + above_; }
  [[nodiscard]] std::optional<double> flank_distance(std::size_t ring, int side, const Vec3& in_space) const;

  tooth_space::ToothedSolid gear_;
  double above_ = 0, top_ = 0;
  std::vector<std::array<std::vector<Start>, 2>> starts_;  ///< [ring][side]
};

}  // namespace toothpath::inspection
