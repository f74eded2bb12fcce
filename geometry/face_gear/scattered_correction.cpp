// The fit of a flank's field to points that stand on no grid.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/face_gear/flank_correction.h"

namespace toothpath::face_gear {
namespace {

constexpr std::size_t kLeastPoints = 45;
constexpr int kLeastLevels = 5, kLeastPlaces = 9;
constexpr double kOneLevel = 0.01;  ///< of the whole spread: values closer than that are one level
constexpr double kLeastCover = 0.5;
constexpr double kWorstCondition = 1e4;
/// A plane through the deviations of one tooth: points, and how evenly they must lie.
constexpr std::size_t kLeastOfPlane = 9;
constexpr double kLeastSpread = 0.02;

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

struct Spread {
  double low = INFINITY, high = -INFINITY;
  explicit Spread(const std::vector<double>& values) {
    for (const double v : values) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  [[nodiscard]] double width() const { return high - low; }
};

Status covered(const std::vector<double>& measured, const std::vector<double>& nominal, const char* what) {
  const Spread have(measured), all(nominal);
  if (have.width() >= kLeastCover * all.width()) return Ok{};
  return fail("the points cover {:.0f} % of the {}, at least {:.0f} % are needed", 100 * have.width() / all.width(),
              what, 100 * kLeastCover);
}

}  // namespace

Result<ScatteredFit> FlankCorrection::fit_scattered(std::span<const ScatteredDeviation> points,
                                                    std::span<const FlankDeviation> nominal, double theta_t,
                                                    CorrectionDegrees most) {
  for (const auto& p : points)
    if (!std::isfinite(p.theta) || !std::isfinite(p.radius_mm) || !std::isfinite(p.deviation_mm))
      return fail("tooth {}: a deviation or its place is not finite", p.tooth);
  if (points.size() < kLeastPoints)
    return fail("{} points are too few to fit, at least {} are needed", points.size(), kLeastPoints);
  FlankCorrection f;
  f.theta_t_ = theta_t;
  int top_row = 0;
  std::vector<double> grid_radii, grid_profile, radii, profile;
  for (const auto& p : nominal) {
    top_row = std::max(top_row, p.row);
    grid_radii.push_back(p.radius_mm);
  }
  for (const auto& p : points) radii.push_back(p.radius_mm);
  if (const auto s = covered(radii, grid_radii, "face width"); !s) return s.error();
  const Spread along(radii);
  f.r_mid_ = 0.5 * (along.low + along.high);
  f.r_half_ = 0.5 * along.width();
  f.fit_top(nominal, top_row);  // the line of the tip is the grid's
  for (const auto& p : nominal) grid_profile.push_back(f.profile_at(p.theta, p.radius_mm));
  for (const auto& p : points) profile.push_back(f.profile_at(p.theta, p.radius_mm));
  if (const auto s = covered(profile, grid_profile, "height of the flank"); !s) return s.error();
  const int levels = levels_of(profile), places = levels_of(radii);
  if (levels < kLeastLevels || places < kLeastPlaces)
    return fail("the points lie at {} heights and {} radii, at least {} and {} are needed", levels, places,
                kLeastLevels, kLeastPlaces);
  constexpr int kMost = int(modification::SmoothCurve::kMostTerms) - 1;
  f.profile_ = std::clamp(std::min(most.profile, kMost), 0, levels - 2);
  f.lead_ = std::clamp(std::min(most.lead, kMost), 0, places - 3);
  return f.fit_teeth(points, Spread(profile).low, Spread(profile).high);
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
    products_at(p.theta, p.radius_mm, row);
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
  const Eigen::VectorXd shape = qr.solve(left);
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
  residual_ = {points.size(),         profile_, lead_, b.cwiseAbs().maxCoeff(), std::sqrt(b.squaredNorm() / n), worst,
               std::sqrt(squares / n)};
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
    const Eigen::Vector3d row(1, (profile_at(p.theta, p.radius_mm) - s_mid_) / s_half_,
                              (p.radius_mm - r_mid_) / r_half_);
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

}  // namespace toothpath::face_gear
