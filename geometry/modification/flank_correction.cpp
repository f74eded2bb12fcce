#include "geometry/modification/flank_correction.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace toothpath::modification {
namespace {

constexpr int kLeastLevels = 5, kLeastPlaces = 9;  // along the profile, along the face

struct Range {
  double low = INFINITY, high = -INFINITY;
  Range() = default;
  explicit Range(const std::vector<double>& values) {
    for (const double v : values) add(v);
  }
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double width() const { return high - low; }
  [[nodiscard]] double half() const { return 0.5 * width(); }
};

// Points that stand on no grid.
constexpr std::size_t kLeastPoints = 45;
constexpr double kOneLevel = 0.01;  ///< of the whole spread: values closer than that are one level
constexpr double kLeastCover = 0.5;
constexpr double kWorstCondition = 1e4;
/// A plane through the deviations of one tooth: points, and how evenly they must lie.
constexpr std::size_t kLeastOfPlane = 9;
constexpr double kLeastSpread = 0.02;
/// Standard deviations of its own that a coefficient must have: of 28 that are noise, with 17 points more than numbers,
/// one in a hundred fits lets one pass.
constexpr double kOutOfNoise = 4.5;

/// How many different values there are, each a step away from the one before.
int levels_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double step = kOneLevel * (values.back() - values.front());
  int levels = 1;
  double last = values.front();
  for (const double v : values)
    if (v - last > step) {
      ++levels;
      last = v;
    }
  return levels;
}

Status covered(const std::vector<double>& measured, const std::vector<double>& nominal, const char* what) {
  const Range have(measured), all(nominal);
  if (have.width() >= kLeastCover * all.width()) return Ok{};
  return fail("the points cover {:.0f} % of the {}, at least {:.0f} % are needed", 100 * have.width() / all.width(),
              what, 100 * kLeastCover);
}

/// Least squares without the columns that noise explains. What all of them leave of the points is their noise; one
/// after the other, the column goes whose coefficient stands least out of it, while that is below `kOutOfNoise`
/// standard deviations of its own. With A = Q R the points are not asked again: what a choice of columns leaves of them
/// is what it leaves of Q' b.
/// @param others  numbers that are fitted besides
/// @param kept    so many of the first columns stay whatever they come to
Eigen::VectorXd solve_out_of_noise(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, const Eigen::VectorXd& b,
                                   Eigen::Index others, Eigen::Index kept) {
  using Eigen::MatrixXd, Eigen::VectorXd;
  const Eigen::Index n = qr.rows(), width = qr.cols(), free = n - width - others;
  VectorXd all = qr.solve(b);
  if (free < 1) return all;
  const VectorXd seen = qr.householderQ().adjoint() * b;
  const double noise = std::sqrt(seen.tail(n - width).squaredNorm() / double(free));
  const MatrixXd R = MatrixXd(qr.matrixQR().topRows(width).triangularView<Eigen::Upper>()) *
                     MatrixXd(qr.colsPermutation()).transpose();
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < width; ++k) columns.push_back(k);
  while (true) {
    const MatrixXd part = R(Eigen::all, columns);
    const VectorXd c = part.householderQr().solve(seen.head(width));
    const MatrixXd spread = (part.transpose() * part).inverse();
    std::size_t least = columns.size();
    double ratio = kOutOfNoise;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto at = Eigen::Index(k);
      const double own = noise * std::sqrt(std::max(spread(at, at), 0.0));
      if (columns[k] >= kept && own > 0 && std::abs(c[at]) < ratio * own) {
        ratio = std::abs(c[at]) / own;
        least = k;
      }
    }
    if (least == columns.size()) {
      if (Eigen::Index(columns.size()) == width) return all;
      all.setZero();
      for (std::size_t k = 0; k < columns.size(); ++k) all[columns[k]] = c[Eigen::Index(k)];
      return all;
    }
    columns.erase(columns.begin() + std::ptrdiff_t(least));
    if (columns.empty()) return VectorXd::Zero(width);
  }
}

}  // namespace

const SmoothCurve& FlankCorrection::chebyshev(std::size_t k) {
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
    if (!std::isfinite(p.theta) || !std::isfinite(p.along_mm) || !std::isfinite(p.deviation_mm))
      return fail("row {}, column {}: the deviation or its place is not finite", p.row, p.column);
    rows.insert(p.row);
    columns.insert(p.column);
    radii.add(p.along_mm);
  }
  if (int(rows.size()) < kLeastLevels || int(columns.size()) < kLeastPlaces)
    return fail("{} rows x {} columns are too few to fit, at least {} x {} are needed", rows.size(), columns.size(),
                kLeastLevels, kLeastPlaces);
  FlankCorrection f;
  f.theta_t_ = theta_t;
  f.r_mid_ = radii.middle();
  f.r_half_ = radii.half();

  f.fit_top(points, *rows.rbegin());

  Range s;
  for (const auto& p : points) s.add(f.profile_at(p.theta, p.along_mm));
  f.s_mid_ = s.middle();
  f.s_half_ = s.half();
  constexpr int kMost = int(SmoothCurve::kMostTerms) - 1;
  f.profile_ = std::clamp(std::min(most.profile, kMost), 0, int(rows.size()) - 2);
  f.lead_ = std::clamp(std::min(most.lead, kMost), 0, int(columns.size()) - 3);

  f.fit_series(points);
  return f;
}

double FlankCorrection::profile_at(double theta, double along_mm) const {
  return (theta_t_ - theta) / (theta_t_ - top_((along_mm - r_mid_) / r_half_));
}

/// theta at the tip over the radius: the top row of the grid, which keeps a margin; the scale of s takes that up.
void FlankCorrection::fit_top(std::span<const FlankDeviation> points, int top_row) {
  std::vector<const FlankDeviation*> tops;
  for (const auto& p : points)
    if (p.row == top_row) tops.push_back(&p);
  Eigen::MatrixXd V(Eigen::Index(tops.size()), 4);
  Eigen::VectorXd w(Eigen::Index(tops.size()));
  for (Eigen::Index k = 0; k < V.rows(); ++k) {
    const double y = (tops[std::size_t(k)]->along_mm - r_mid_) / r_half_;
    V.row(k) << 1, y, y * y, y * y * y;
    w[k] = tops[std::size_t(k)]->theta;
  }
  const Eigen::VectorXd line = V.colPivHouseholderQr().solve(w);
  top_ = SmoothCurve({-1, 1}, {{0, {line[0], line[1], line[2], line[3]}}});
}

void FlankCorrection::products_at(double theta, double along_mm, Eigen::Ref<Eigen::RowVectorXd> row) const {
  const double x = (profile_at(theta, along_mm) - s_mid_) / s_half_, y = (along_mm - r_mid_) / r_half_;
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
    products_at(p.theta, p.along_mm, row);
    A.row(k) = row;
    b[k] = -p.deviation_mm;
  }
  const Eigen::VectorXd c = solve_out_of_noise(A.colPivHouseholderQr(), b, 0, 1);
  coefficients_.assign(c.data(), c.data() + c.size());
  const Eigen::VectorXd left = b - A * c;
  residual_.points = points.size();
  residual_.profile_degree = profile_;
  residual_.lead_degree = lead_;
  residual_.measured_max_mm = b.cwiseAbs().maxCoeff();
  residual_.measured_rms_mm = std::sqrt(b.squaredNorm() / double(n));
  residual_.residual_max_mm = left.cwiseAbs().maxCoeff();
  residual_.residual_rms_mm = std::sqrt(left.squaredNorm() / double(n));
}

FlankCorrection::Offset FlankCorrection::at(double theta, double along_mm) const {
  using Dual2 = Dual<double, 2>;
  const Dual2 c = offset(Dual2::variable(theta, 0), Dual2::variable(along_mm, 1));
  return {c.v, c.d[0], c.d[1]};
}

Result<ScatteredFit> FlankCorrection::fit_scattered(std::span<const ScatteredDeviation> points,
                                                    std::span<const FlankDeviation> nominal, double theta_t,
                                                    CorrectionDegrees most) {
  for (const auto& p : points)
    if (!std::isfinite(p.theta) || !std::isfinite(p.along_mm) || !std::isfinite(p.deviation_mm))
      return fail("tooth {}: a deviation or its place is not finite", p.tooth);
  if (points.size() < kLeastPoints)
    return fail("{} points are too few to fit, at least {} are needed", points.size(), kLeastPoints);
  FlankCorrection f;
  f.theta_t_ = theta_t;
  int top_row = 0;
  std::vector<double> grid_radii, grid_profile, radii, profile;
  for (const auto& p : nominal) {
    top_row = std::max(top_row, p.row);
    grid_radii.push_back(p.along_mm);
  }
  for (const auto& p : points) radii.push_back(p.along_mm);
  if (const auto s = covered(radii, grid_radii, "face width"); !s) return s.error();
  const Range along(radii);
  f.r_mid_ = along.middle();
  f.r_half_ = along.half();
  f.fit_top(nominal, top_row);  // the line of the tip is the grid's
  for (const auto& p : nominal) grid_profile.push_back(f.profile_at(p.theta, p.along_mm));
  for (const auto& p : points) profile.push_back(f.profile_at(p.theta, p.along_mm));
  if (const auto s = covered(profile, grid_profile, "height of the flank"); !s) return s.error();
  const int levels = levels_of(profile), places = levels_of(radii);
  if (levels < kLeastLevels || places < kLeastPlaces)
    return fail("the points lie at {} heights and {} radii, at least {} and {} are needed", levels, places,
                kLeastLevels, kLeastPlaces);
  constexpr int kMost = int(SmoothCurve::kMostTerms) - 1;
  f.profile_ = std::clamp(std::min(most.profile, kMost), 0, levels - 2);
  f.lead_ = std::clamp(std::min(most.lead, kMost), 0, places - 3);
  return f.fit_teeth(points, Range(profile).low, Range(profile).high);
}

/// One constant a tooth, one shape for all: the constants go first (each tooth less its own mean), then the shape.
Result<ScatteredFit> FlankCorrection::fit_teeth(std::span<const ScatteredDeviation> points, double s_low,
                                                double s_high) {
  s_mid_ = 0.5 * (s_low + s_high);
  s_half_ = 0.5 * (s_high - s_low);
  const auto n = Eigen::Index(points.size()), width = Eigen::Index((profile_ + 1) * (lead_ + 1));
  Eigen::MatrixXd A(n, width);
  Eigen::VectorXd b(n);
  Eigen::RowVectorXd row(width);
  struct Tooth {
    Eigen::RowVectorXd A;
    double b = 0;
    std::size_t points = 0;
  };
  std::map<int, Tooth> teeth;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& p = points[std::size_t(k)];
    products_at(p.theta, p.along_mm, row);
    A.row(k) = row;
    b[k] = p.deviation_mm;
    Tooth& tooth = teeth[p.tooth];
    if (tooth.points == 0) tooth.A = Eigen::RowVectorXd::Zero(width);
    tooth.A += row;
    tooth.b += b[k];
    ++tooth.points;
  }
  Eigen::MatrixXd inside = A.rightCols(width - 1);
  Eigen::VectorXd left = b;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Tooth& tooth = teeth[points[std::size_t(k)].tooth];
    inside.row(k) -= tooth.A.rightCols(width - 1) / double(tooth.points);
    left[k] -= tooth.b / double(tooth.points);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(inside);
  const auto diagonal = qr.matrixQR().diagonal().cwiseAbs();
  const double condition = n < width ? INFINITY : diagonal.maxCoeff() / diagonal.minCoeff();
  if (!(condition <= kWorstCondition))
    return fail(
        "the points leave part of the flank open: a fit of degrees {} x {} has condition {:.3g}, at most {:g}; "
        "measure points spread over height and width, not along single lines",
        profile_, lead_, condition, kWorstCondition);
  const Eigen::VectorXd shape = solve_out_of_noise(qr, left, Eigen::Index(teeth.size()), 0);
  ScatteredFit out;
  double mean = 0;
  for (const auto& [tooth, sums] : teeth) {
    const double own = (sums.b - sums.A.rightCols(width - 1).dot(shape)) / double(sums.points);
    out.teeth.push_back({tooth, own, own, sums.points});
    mean += own / double(teeth.size());
  }
  coefficients_.assign(1, -mean);
  for (const double c : shape) coefficients_.push_back(-c);
  note_rest(points, b, b - A.rightCols(width - 1) * shape, out.teeth);
  out.field = std::move(*this);
  return out;
}

/// Residuals and the middles of the teeth. @param rest  deviations less the shape, with the constants of the teeth
void FlankCorrection::note_rest(std::span<const ScatteredDeviation> points, const Eigen::VectorXd& b,
                                const Eigen::VectorXd& rest, std::vector<ToothOffset>& teeth) {
  note_middles(points, rest, teeth);
  std::map<int, double> own;
  for (const auto& tooth : teeth) own[tooth.tooth] = tooth.mean_mm;
  double worst = 0, squares = 0;
  for (Eigen::Index k = 0; k < rest.size(); ++k) {
    const double off = rest[k] - own[points[std::size_t(k)].tooth];
    worst = std::max(worst, std::abs(off));
    squares += off * off;
  }
  const double n = double(points.size());
  residual_.points = points.size();
  residual_.profile_degree = profile_;
  residual_.lead_degree = lead_;
  residual_.measured_max_mm = b.cwiseAbs().maxCoeff();
  residual_.measured_rms_mm = std::sqrt(b.squaredNorm() / n);
  residual_.residual_max_mm = worst;
  residual_.residual_rms_mm = std::sqrt(squares / n);
}

void FlankCorrection::note_middles(std::span<const ScatteredDeviation> points, const Eigen::VectorXd& rest,
                                   std::vector<ToothOffset>& teeth) const {
  struct Plane {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
  };
  std::map<int, Plane> planes;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& p = points[k];
    const Eigen::Vector3d row(1, (profile_at(p.theta, p.along_mm) - s_mid_) / s_half_, (p.along_mm - r_mid_) / r_half_);
    planes[p.tooth].A += row * row.transpose();
    planes[p.tooth].b += row * rest[Eigen::Index(k)];
  }
  for (ToothOffset& tooth : teeth) {
    const Plane& plane = planes[tooth.tooth];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(plane.A);
    if (tooth.points < kLeastOfPlane || spread.eigenvalues()[0] < kLeastSpread * spread.eigenvalues()[2]) continue;
    tooth.middle_mm = plane.A.ldlt().solve(plane.b)[0];
  }
}

}  // namespace toothpath::modification
