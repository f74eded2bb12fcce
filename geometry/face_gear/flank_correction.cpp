#include "geometry/face_gear/flank_correction.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>

namespace toothpath::face_gear {
namespace {

constexpr int kLeastRows = 5, kLeastColumns = 9;

struct Range {
  double low = INFINITY, high = -INFINITY;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double half() const { return 0.5 * (high - low); }
};

}  // namespace

const modification::SmoothCurve& FlankCorrection::chebyshev(std::size_t k) {
  using modification::SmoothCurve;
  static const std::vector<SmoothCurve> kCurves = [] {
    std::vector<std::array<double, SmoothCurve::kMostTerms>> c(SmoothCurve::kMostTerms);
    c[0][0] = c[1][1] = 1;
    for (std::size_t n = 2; n < c.size(); ++n)
      for (std::size_t p = 0; p <= n; ++p) c[n][p] = (p > 0 ? 2 * c[n - 1][p - 1] : 0) - c[n - 2][p];
    std::vector<SmoothCurve> curves;
    for (const auto& terms : c) curves.push_back(SmoothCurve({-1, 1}, {{0, terms}}));
    return curves;
  }();
  return kCurves[k];
}

FlankCorrection FlankCorrection::plus(const FlankCorrection& other) const {
  FlankCorrection sum = *this;
  sum.other_ = std::make_shared<FlankCorrection>(other_ ? other_->plus(other) : other);
  return sum;
}

Result<FlankCorrection> FlankCorrection::fit(std::span<const FlankDeviation> points, double theta_t,
                                             CorrectionDegrees most) {
  std::set<int> rows, columns;
  Range radii;
  for (const auto& p : points) {
    if (!std::isfinite(p.theta) || !std::isfinite(p.radius_mm) || !std::isfinite(p.deviation_mm))
      return fail("row {}, column {}: the deviation or its place is not finite", p.row, p.column);
    rows.insert(p.row);
    columns.insert(p.column);
    radii.add(p.radius_mm);
  }
  if (int(rows.size()) < kLeastRows || int(columns.size()) < kLeastColumns)
    return fail("{} rows x {} columns are too few to fit, at least {} x {} are needed", rows.size(), columns.size(),
                kLeastRows, kLeastColumns);
  FlankCorrection f;
  f.theta_t_ = theta_t;
  f.r_mid_ = radii.middle();
  f.r_half_ = radii.half();

  f.fit_top(points, *rows.rbegin());

  Range s;
  for (const auto& p : points) s.add(f.profile_at(p.theta, p.radius_mm));
  f.s_mid_ = s.middle();
  f.s_half_ = s.half();
  constexpr int kMost = int(modification::SmoothCurve::kMostTerms) - 1;
  f.profile_ = std::clamp(std::min(most.profile, kMost), 0, int(rows.size()) - 2);
  f.lead_ = std::clamp(std::min(most.lead, kMost), 0, int(columns.size()) - 3);

  f.fit_series(points);
  return f;
}

double FlankCorrection::profile_at(double theta, double radius_mm) const {
  return (theta_t_ - theta) / (theta_t_ - top_((radius_mm - r_mid_) / r_half_));
}

/// theta at the tip over the radius: the top row of the grid, which keeps a margin; the scale of s takes that up.
void FlankCorrection::fit_top(std::span<const FlankDeviation> points, int top_row) {
  std::vector<const FlankDeviation*> tops;
  for (const auto& p : points)
    if (p.row == top_row) tops.push_back(&p);
  Eigen::MatrixXd V(Eigen::Index(tops.size()), 4);
  Eigen::VectorXd w(Eigen::Index(tops.size()));
  for (Eigen::Index k = 0; k < V.rows(); ++k) {
    const double y = (tops[std::size_t(k)]->radius_mm - r_mid_) / r_half_;
    V.row(k) << 1, y, y * y, y * y * y;
    w[k] = tops[std::size_t(k)]->theta;
  }
  const Eigen::VectorXd line = V.colPivHouseholderQr().solve(w);
  top_ = modification::SmoothCurve({-1, 1}, {{0, {line[0], line[1], line[2], line[3]}}});
}

void FlankCorrection::products_at(double theta, double radius_mm, Eigen::Ref<Eigen::RowVectorXd> row) const {
  const double x = (profile_at(theta, radius_mm) - s_mid_) / s_half_, y = (radius_mm - r_mid_) / r_half_;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i <= std::size_t(profile_); ++i)
    for (std::size_t j = 0; j <= std::size_t(lead_); ++j) row[column++] = chebyshev(i)(x) * chebyshev(j)(y);
}

void FlankCorrection::fit_series(std::span<const FlankDeviation> points) {
  const auto n = Eigen::Index(points.size()), width = Eigen::Index((profile_ + 1) * (lead_ + 1));
  Eigen::MatrixXd A(n, width);
  Eigen::VectorXd b(n);
  Eigen::RowVectorXd row(width);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& p = points[std::size_t(k)];
    products_at(p.theta, p.radius_mm, row);
    A.row(k) = row;
    b[k] = -p.deviation_mm;
  }
  const Eigen::VectorXd c = A.colPivHouseholderQr().solve(b);
  coefficients_.assign(c.data(), c.data() + c.size());
  const Eigen::VectorXd left = b - A * c;
  residual_ = {points.size(),
               profile_,
               lead_,
               b.cwiseAbs().maxCoeff(),
               std::sqrt(b.squaredNorm() / double(n)),
               left.cwiseAbs().maxCoeff(),
               std::sqrt(left.squaredNorm() / double(n))};
}

FlankCorrection::Offset FlankCorrection::at(double theta, double radius_mm) const {
  using Dual2 = Dual<double, 2>;
  const Dual2 c = offset(Dual2::variable(theta, 0), Dual2::variable(radius_mm, 1));
  return {c.v, c.d[0], c.d[1]};
}

}  // namespace toothpath::face_gear
