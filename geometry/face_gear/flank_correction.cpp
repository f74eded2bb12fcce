#include "geometry/face_gear/flank_correction.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>

namespace toothpath::face_gear {
namespace {

constexpr int kLeastRows = 5, kLeastColumns = 9;

/// T_0 .. T_n and their derivatives at x; beyond [-1, 1] along the tangents.
void chebyshev(double x, int n, std::vector<double>& T, std::vector<double>& dT) {
  const double inside = std::clamp(x, -1.0, 1.0), beyond = x - inside;
  T.assign(std::size_t(n) + 1, 1.0);
  dT.assign(std::size_t(n) + 1, 0.0);
  if (n >= 1) {
    T[1] = inside;
    dT[1] = 1;
  }
  for (std::size_t k = 2; k <= std::size_t(n); ++k) {
    T[k] = 2 * inside * T[k - 1] - T[k - 2];
    dT[k] = 2 * T[k - 1] + 2 * inside * dT[k - 1] - dT[k - 2];
  }
  for (std::size_t k = 0; k <= std::size_t(n); ++k) T[k] += beyond * dT[k];
}

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

double FlankCorrection::top(double r, double* slope) const {
  const double y = (r - r_mid_) / r_half_, inside = std::clamp(y, -1.0, 1.0), beyond = y - inside;
  const double d = top_[1] + inside * (2 * top_[2] + inside * 3 * top_[3]);
  if (slope) *slope = d / r_half_;
  return top_[0] + inside * (top_[1] + inside * (top_[2] + inside * top_[3])) + beyond * d;
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
  f.profile_ = std::clamp(most.profile, 0, int(rows.size()) - 2);
  f.lead_ = std::clamp(most.lead, 0, int(columns.size()) - 3);

  f.fit_series(points);
  return f;
}

double FlankCorrection::profile_at(double theta, double radius_mm) const {
  return (theta_t_ - theta) / (theta_t_ - top(radius_mm, nullptr));
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
  for (std::size_t k = 0; k < 4; ++k) top_[k] = line[Eigen::Index(k)];
}

void FlankCorrection::products_at(double theta, double radius_mm, Eigen::Ref<Eigen::RowVectorXd> row) const {
  thread_local std::vector<double> X, dX, Y, dY;
  chebyshev((profile_at(theta, radius_mm) - s_mid_) / s_half_, profile_, X, dX);
  chebyshev((radius_mm - r_mid_) / r_half_, lead_, Y, dY);
  Eigen::Index column = 0;
  for (const double x : X)
    for (const double y : Y) row[column++] = x * y;
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
  double slope = 0;
  const double tip = top(radius_mm, &slope), height = theta_t_ - tip, s = (theta_t_ - theta) / height;
  thread_local std::vector<double> X, dX, Y, dY;
  chebyshev((s - s_mid_) / s_half_, profile_, X, dX);
  chebyshev((radius_mm - r_mid_) / r_half_, lead_, Y, dY);
  double value = 0, d_s = 0, d_r = 0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < X.size(); ++i)
    for (std::size_t j = 0; j < Y.size(); ++j, ++k) {
      value += coefficients_[k] * X[i] * Y[j];
      d_s += coefficients_[k] * dX[i] * Y[j];
      d_r += coefficients_[k] * X[i] * dY[j];
    }
  d_s /= s_half_;
  Offset sum{value, -d_s / height, d_r / r_half_ + d_s * s * slope / height};
  if (other_) {
    const Offset more = other_->at(theta, radius_mm);
    sum = {sum.value + more.value, sum.d_theta + more.d_theta, sum.d_radius + more.d_radius};
  }
  return sum;
}

}  // namespace toothpath::face_gear
