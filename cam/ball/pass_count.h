// How many finishing passes lie side by side on a sheet of ball centres: along every profile (a station of the sheet) a count grows by
// one from pass to pass, for cusps of the asked height.
#pragma once

#include <vector>

#include "cam/ball/finishing.h"
#include "geometry/face_gear/offset_sheet.h"

namespace toothpath::ball {

/// Where a pass crosses a profile: its place there, and the unit direction in which it goes on.
struct PassPlace {
  double sigma = 0;
  face_gear::SheetPoint at;
  Vec3 feed = Vec3::Zero();
};

/// Counts by the curvature across the passes first; then every cusp is measured between its two passes, and the passes are drawn
/// together where it is higher than asked. Holds a reference to the sheet, which must have a station.
class PassCount {
 public:
  PassCount(const face_gear::OffsetSheet& sheet, const FinishingOptions& options);

  /// Passes over the whole profile, one number a station of the sheet. Gaps of the sheet count nothing.
  [[nodiscard]] const std::vector<double>& totals() const { return totals_; }
  /// Count from the first tip to `sigma` at station j, and the place where a count is reached. Beyond the ends: the end.
  [[nodiscard]] double count_at(std::size_t j, double sigma) const;
  [[nodiscard]] double sigma_at(std::size_t j, double count) const;

  /// Highest place [mm] of the surface at centre radius r between two passes, above what both balls leave.
  /// The allowance is left out, and so are places behind `gaps`: a corner that the ball does not reach has a pass of its own.
  [[nodiscard]] double cusp(const PassPlace& a, const PassPlace& b, double r, const std::vector<face_gear::SheetGap>& gaps) const;

 private:
  struct Profile {
    std::vector<double> sigma, count;  ///< same length, both ascending; gaps are jumps in sigma at equal count
  };

  [[nodiscard]] double spacing(const face_gear::SheetPoint& s, const Vec3& feed) const;
  void count_profiles();
  void sharpen();
  [[nodiscard]] std::vector<double> sharpened(std::size_t j) const;
  [[nodiscard]] Vec3 direction_at(std::size_t j, double sigma, double share) const;
  [[nodiscard]] Vec3 feed_direction(std::size_t j, std::size_t k, int round) const;

  const face_gear::OffsetSheet& sheet_;
  FinishingOptions o_;
  std::vector<Profile> profiles_;
  std::vector<double> totals_;
};

}  // namespace toothpath::ball
