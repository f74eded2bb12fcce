// Corrected flanks: the nominal ones moved along their normals by a smooth field that answers a measurement.
//
// A field lives on two coordinates of one flank: theta, which is the same all along the fillet line (of a face gear the
// roll parameter, of any other gear the depth below the tip), and r along the tooth (of a face gear the radius).
// Profile coordinate s = (theta_t - theta)/(theta_t - top(r)), 0 at the fillet line and 1 at the tip; lead coordinate
// r. Both are mapped to [-1, 1] over the measured points, where the field is a sum of products of Chebyshev
// polynomials; outside, every polynomial goes on along its tangent, so the field is C1 everywhere and does not run
// away.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/modification/smooth_curve.h"

namespace toothpath::modification {

/// One measured point of a flank.
struct FlankDeviation {
  int row = 0, column = 0;         ///< of the inspection grid
  double theta = 0, along_mm = 0;  ///< of the nominal point
  double deviation_mm = 0;         ///< along the normal, positive: material left
};

/// One measured point anywhere on a flank of any tooth.
struct ScatteredDeviation {
  int tooth = 0;
  double theta = 0, along_mm = 0;  ///< of its foot on the nominal flank
  double deviation_mm = 0;         ///< along the normal, positive: material left
};

/// Mean deviation of a flank of one tooth from the shape common to all teeth.
struct ToothOffset {
  int tooth = 0;
  double mean_mm = 0;
  double middle_mm = 0;  ///< in the middle of the flank: of a plane through its deviations, or the mean where too few
  std::size_t points = 0;
};

/// Highest degrees of the fit; the grid allows at most rows - 2 and columns - 3.
struct CorrectionDegrees {
  int profile = 3, lead = 6;
};

/// How well the field follows the measured points of one flank.
struct CorrectionResidual {
  std::size_t points = 0;
  int profile_degree = 0, lead_degree = 0;
  double measured_max_mm = 0, measured_rms_mm = 0;  ///< of the deviations, sizes
  double residual_max_mm = 0, residual_rms_mm = 0;  ///< deviation minus fit
};

struct ScatteredFit;

class FlankCorrection {
 public:
  /// Least squares over the points of one flank; the target is moved by minus the fit.
  /// @param theta_t of the fillet line
  /// Errors: too few rows or columns (5 and 9), values that are not finite.
  [[nodiscard]] static Result<FlankCorrection> fit(std::span<const FlankDeviation> points, double theta_t,
                                                   CorrectionDegrees most = {});

  /// The same from points anywhere, of one flank of several teeth. Each tooth has a constant of its own: a tooth that
  /// stands off its place does not bend the shape. The field is the common shape with the mean of those constants.
  /// Degrees are at most the levels of the points less 2 (profile) and 3 (face).
  /// @param nominal  points of the inspection grid of this flank: their uppermost row gives the tip, their spread what
  ///                 must be covered; deviations are not looked at
  /// Errors: values that are not finite; fewer than 45 points, 5 levels along the profile or 9 along the face; less
  /// than half of the grid's height or width covered; points in lines that leave part of the flank open.
  [[nodiscard]] static Result<ScatteredFit> fit_scattered(std::span<const ScatteredDeviation> points,
                                                          std::span<const FlankDeviation> nominal, double theta_t,
                                                          CorrectionDegrees most = {});

  /// The sum of two fields; `residual()` stays that of this one.
  [[nodiscard]] FlankCorrection plus(const FlankCorrection& other) const;

  /// Offset of the target from the nominal flank, mm along its normal, with derivatives.
  struct Offset {
    double value = 0, d_theta = 0, d_along = 0;
  };
  [[nodiscard]] Offset at(double theta, double along_mm) const;
  /// The value in any scalar of the kernels.
  template <typename S>
  [[nodiscard]] S offset(const S& theta, const S& along_mm) const {
    const S y = (along_mm - S(r_mid_)) / S(r_half_),
            x = ((S(theta_t_) - theta) / (S(theta_t_) - top_(y)) - S(s_mid_)) / S(s_half_);
    S sum(0);
    std::size_t k = 0;
    for (std::size_t i = 0; i <= std::size_t(profile_); ++i) {
      S along(0);
      for (std::size_t j = 0; j <= std::size_t(lead_); ++j) along = along + chebyshev(j)(y) * S(coefficients_[k++]);
      sum = sum + chebyshev(i)(x) * along;
    }
    return other_ ? sum + other_->offset(theta, along_mm) : sum;
  }
  [[nodiscard]] const CorrectionResidual& residual() const { return residual_; }

 private:
  /// T_k, k <= 6.
  static const SmoothCurve& chebyshev(std::size_t k);
  [[nodiscard]] double profile_at(double theta, double along_mm) const;  ///< 0 at the fillet line, 1 at the tip
  void fit_top(std::span<const FlankDeviation> points, int top_row);
  void fit_series(std::span<const FlankDeviation> points);
  [[nodiscard]] Result<ScatteredFit> fit_teeth(std::span<const ScatteredDeviation> points, double s_low, double s_high);
  void note_rest(std::span<const ScatteredDeviation> points, const Eigen::VectorXd& b, const Eigen::VectorXd& rest,
                 std::vector<ToothOffset>& teeth);
  /// Where the teeth stand, from what the shape leaves of their deviations.
  void note_middles(std::span<const ScatteredDeviation> points, const Eigen::VectorXd& rest,
                    std::vector<ToothOffset>& teeth) const;
  /// Products of the polynomials at a place, into a row.
  void products_at(double theta, double along_mm, Eigen::Ref<Eigen::RowVectorXd> row) const;
  double theta_t_ = 0;
  double s_mid_ = 0, s_half_ = 1, r_mid_ = 0, r_half_ = 1;
  SmoothCurve top_;  ///< theta at the tip over the mapped radius, a cubic
  int profile_ = 0, lead_ = 0;
  std::vector<double> coefficients_;  ///< (profile + 1) x (lead + 1), row-major, mm; of the offset
  CorrectionResidual residual_;
  std::shared_ptr<const FlankCorrection> other_;  ///< added; none: this field alone
};

struct ScatteredFit {
  FlankCorrection field;
  std::vector<ToothOffset> teeth;  ///< ascending; with the mean of all teeth
};

/// Both flanks of one ring.
struct RingCorrection {
  FlankCorrection plus, minus;  ///< sides +1 and -1
  [[nodiscard]] const FlankCorrection& side(int s) const { return s > 0 ? plus : minus; }
};

}  // namespace toothpath::modification
