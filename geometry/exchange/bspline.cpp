#include "geometry/exchange/bspline.h"

#include <Eigen/LU>
#include <algorithm>

namespace toothpath::exchange {
namespace {

using Places = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Values of all basis functions at the Greville points, ready to be solved.
Eigen::PartialPivLU<Eigen::MatrixXd> collocation(const Breaks& breaks) {
  const auto knots = clamped_knots(breaks);
  const auto points = greville_points(breaks);
  const auto n = Eigen::Index(points.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index row = 0; row < n; ++row) {
    const BasisAt basis = basis_at(knots, points[std::size_t(row)]);
    for (std::size_t k = 0; k < basis.value.size(); ++k) matrix(row, Eigen::Index(basis.first + k)) = basis.value[k];
  }
  return Eigen::PartialPivLU<Eigen::MatrixXd>(matrix);
}

}  // namespace

Breaks even_breaks(std::size_t pieces) {
  Breaks breaks;
  for (std::size_t k = 0; k < pieces; ++k) breaks.push_back(double(k) / double(pieces));
  breaks.push_back(1);
  return breaks;
}

std::vector<double> clamped_knots(const Breaks& breaks) {
  std::vector<double> knots(kDegree, breaks.front());
  knots.insert(knots.end(), breaks.begin(), breaks.end());
  knots.insert(knots.end(), kDegree, breaks.back());
  return knots;
}

std::vector<double> greville_points(const Breaks& breaks) {
  const auto knots = clamped_knots(breaks);
  std::vector<double> points;
  for (std::size_t k = 0; k < control_count(breaks); ++k)
    points.push_back((knots[k + 1] + knots[k + 2] + knots[k + 3]) / 3);
  points.front() = breaks.front();
  points.back() = breaks.back();
  return points;
}

BasisAt basis_at(const std::vector<double>& knots, double t) {
  const std::size_t last = knots.size() - kDegree - 2;  // piece that ends at the end
  std::size_t piece = std::size_t(std::upper_bound(knots.begin(), knots.end(), t) - knots.begin());
  piece = std::clamp(piece - std::min<std::size_t>(piece, 1), std::size_t(kDegree), last);
  BasisAt out;
  out.first = piece - kDegree;
  std::array<double, kDegree + 1> left{}, right{};
  out.value[0] = 1;
  for (std::size_t j = 1; j <= kDegree; ++j) {
    left[j] = t - knots[piece + 1 - j];
    right[j] = knots[piece + j] - t;
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double share = out.value[r] / (right[r + 1] + left[j - r]);
      out.value[r] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    out.value[j] = saved;
  }
  return out;
}

Vec3 SplineCurve::at(double t) const {
  const BasisAt basis = basis_at(clamped_knots(breaks), t);
  Vec3 p = Vec3::Zero();
  for (std::size_t k = 0; k < basis.value.size(); ++k) p += basis.value[k] * control[basis.first + k];
  return p;
}

SplineCurve curve_through(const Breaks& breaks, const std::vector<Vec3>& places) {
  Places data(Eigen::Index(places.size()), 3);
  for (std::size_t k = 0; k < places.size(); ++k) data.row(Eigen::Index(k)) = places[k].transpose();
  const Places solved = collocation(breaks).solve(data);
  SplineCurve curve{breaks, {}};
  for (Eigen::Index k = 0; k < solved.rows(); ++k) curve.control.push_back(solved.row(k).transpose());
  return curve;
}

Vec3 SplineSurface::at(double s, double t) const {
  const BasisAt across = basis_at(clamped_knots(v), t), along = basis_at(clamped_knots(u), s);
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < along.value.size(); ++i)
    for (std::size_t j = 0; j < across.value.size(); ++j)
      p += along.value[i] * across.value[j] * point(along.first + i, across.first + j);
  return p;
}

SplineSurface surface_through(const Breaks& u, const Breaks& v, const std::vector<Vec3>& places) {
  const auto rows = Eigen::Index(control_count(u)), columns = Eigen::Index(control_count(v));
  const auto along = collocation(u), across = collocation(v);
  SplineSurface surface{u, v, std::vector<Vec3>(places.size())};
  for (int axis = 0; axis < 3; ++axis) {
    Places data(rows, columns);
    for (Eigen::Index k = 0; k < data.size(); ++k) data.data()[k] = places[std::size_t(k)][axis];
    const Places half = along.solve(data);
    const Places solved = across.solve(half.transpose()).transpose();
    for (Eigen::Index k = 0; k < solved.size(); ++k) surface.control[std::size_t(k)][axis] = solved.data()[k];
  }
  return surface;
}

}  // namespace toothpath::exchange
