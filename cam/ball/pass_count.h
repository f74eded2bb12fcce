// How many finishing passes lie side by side on a sheet of ball centres: along every profile (a station of the sheet) a
// count grows by one from pass to pass, for cusps of the asked height.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cam/ball/finishing.h"
#include "geometry/tooth_space/offset_sheet.h"

namespace toothpath::ball {

/// A pass as its neighbours see it near one place: the parabola c + f t + b t^2 over the way t.
struct PassLine {
  double sigma = 0;
  tooth_space::SheetPoint at;  ///< c is its centre
  Vec3 feed = Vec3::Zero();    ///< f, unit
  Vec3 bend = Vec3::Zero();    ///< b, 1/mm

  /// Through a place and the ball centres of the pass before and after it; one of the two may be missing: then the line
  /// is straight.
  PassLine(double sigma, const tooth_space::SheetPoint& at, const std::optional<Vec3>& before,
           const std::optional<Vec3>& after);
  /// From a point within a few ball radii.
  [[nodiscard]] double distance(const Vec3& p) const;
};

/// The highest place between two passes.
struct Crest {
  double height_mm = 0;
  double lean = 0;  ///< sine of the angle at the ball centre from a contact to the crest: what of a pass's error
                    ///< sideways shows in the height
};

/// A cusp between two passes at centre radius r, seen between `sigma_a` and `sigma_b`.
struct HighCusp {
  double r = 0, sigma_a = 0, sigma_b = 0;
  Crest crest;
};

/// Counts by the curvature across the passes first; then every cusp is measured between its two passes, and the passes
/// are drawn together where it is higher than asked. Holds a reference to the sheet, which must have a station.
class PassCount {
 public:
  static constexpr int kCuspRounds = 4;
  /// @param cusp_rounds  how often cusps are measured; 0: counted by the curvature alone, quickly
  PassCount(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options, int cusp_rounds = kCuspRounds);

  /// Passes over the whole profile, one number a station of the sheet. Gaps of the sheet count nothing.
  [[nodiscard]] const std::vector<double>& totals() const { return totals_; }
  /// Count from the first tip to `sigma` at station j, and the place where a count is reached. Beyond the ends: the
  /// end.
  [[nodiscard]] double count_at(std::size_t j, double sigma) const;
  [[nodiscard]] double sigma_at(std::size_t j, double count) const;

  /// Counts more where cusps of the final passes are higher than asked: passes laid anew are closer there.
  void draw_together(std::span<const HighCusp> cusps);

  /// Highest place of the surface at centre radius r between two passes, above what both balls leave. The allowance is
  /// left out, and so are places behind `gaps`: a corner that the ball does not reach has a pass of its own.
  [[nodiscard]] Crest cusp(const PassLine& a, const PassLine& b, double r,
                           const std::vector<tooth_space::SheetGap>& gaps) const;

 private:
  struct Profile {
    std::vector<double> sigma, count;  ///< same length, both ascending; gaps are jumps in sigma at equal count
  };

  [[nodiscard]] double spacing(double sigma, const tooth_space::SheetPoint& s, const Vec3& feed) const;
  void count_profiles();
  void sharpen();
  [[nodiscard]] std::vector<double> growth(std::size_t j) const;
  void apply(std::size_t j, const std::vector<double>& grow);
  [[nodiscard]] std::optional<PassLine> line_at(std::size_t j, double count) const;
  [[nodiscard]] Vec3 feed_direction(std::size_t j, std::size_t k, int round) const;

  const tooth_space::OffsetSheet& sheet_;
  FinishingOptions o_;
  std::vector<Profile> profiles_;
  std::vector<double> totals_;
};

}  // namespace toothpath::ball
