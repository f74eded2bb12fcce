// Passes whose tool axis turns: places along the ball centre, and the records that such an axis needs.
#pragma once

#include <functional>
#include <vector>

#include "cam/ball/finishing.h"

namespace toothpath::ball {

/// Greatest turn of the axis between two neighbouring records of a pass, rad.
inline constexpr double kMostTurnPerRecord = 0.0175;

/// Ball centre between two records, tips straight and axes blended: this far from the straight line of centres. From
/// |n - (blend before normalising)| <= 1 - cos(turn / 2) <= turn^2 / 8.
[[nodiscard]] inline double centre_sag(double ball_radius_mm, double turn_rad) {
  return ball_radius_mm * turn_rad * turn_rad / 8;
}

/// The place at the share t of the way between two points of a pass.
[[nodiscard]] BallPass::Point blend_points(const BallPass::Point& a, const BallPass::Point& b, double t);

/// A pass by the way of its ball centre.
class PassTrack {
 public:
  /// Keeps a reference to the pass, which must have a point.
  explicit PassTrack(const BallPass& pass);
  /// mm along the centre, of every point.
  [[nodiscard]] const std::vector<double>& at() const { return at_; }
  [[nodiscard]] const std::vector<BallPass::Point>& points() const { return *points_; }
  [[nodiscard]] BallPass::Point point(double s) const;

 private:
  std::vector<double> at_;
  const std::vector<BallPass::Point>* points_;
};

/// Points of a pass with an axis each.
struct AxisRecords {
  std::vector<BallPass::Point> points;
  std::vector<Vec3> axes;
};

/// The points of the pass, and more where the axis turns: between two records by no more than kMostTurnPerRecord, and
/// so little that the centre leaves the pass by at most `chord_mm` (centre_sag).
/// @param axis  unit axis at s mm along the centre
[[nodiscard]] AxisRecords records_with_axes(const PassTrack& track, const std::function<Vec3(double s)>& axis,
                                            double chord_mm, double ball_radius_mm);

}  // namespace toothpath::ball
