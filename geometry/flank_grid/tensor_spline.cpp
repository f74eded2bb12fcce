#include "geometry/flank_grid/tensor_spline.h"

#include <Eigen/LU>
#include <cassert>
#include <utility>

namespace toothpath::flank_grid {
namespace {

using Matrix = Eigen::MatrixXd;

/// Slopes of the cubic spline through values at rising knots, four or more: slopes = M values. Source: C. de Boor, A
/// Practical Guide to Splines, 1978, IV.
Matrix slopes_of(const std::vector<double>& x) {
  const auto n = Eigen::Index(x.size());
  assert(n >= 4);
  const auto h = [&](Eigen::Index k) { return x[std::size_t(k) + 1] - x[std::size_t(k)]; };
  // slopes of neighbours, and on the right values; an end: the third derivative does not jump at the next knot.
  Matrix A = Matrix::Zero(n, n), B = Matrix::Zero(n, n);
  for (Eigen::Index k = 1; k + 1 < n; ++k) {
    const double a = 1 / h(k - 1), b = 1 / h(k);
    A(k, k - 1) = a;
    A(k, k) = 2 * (a + b);
    A(k, k + 1) = b;
    B(k, k - 1) = -3 * a * a;
    B(k, k) = 3 * (a * a - b * b);
    B(k, k + 1) = 3 * b * b;
  }
  for (const Eigen::Index row : {Eigen::Index(0), n - 1}) {
    const Eigen::Index k = row == 0 ? 0 : n - 3;
    const double a = 1 / h(k), b = 1 / h(k + 1);
    A(row, k) = a * a;
    A(row, k + 1) = a * a - b * b;
    A(row, k + 2) = -b * b;
    B(row, k) = -2 * a * a * a;
    B(row, k + 1) = 2 * (a * a * a + b * b * b);
    B(row, k + 2) = -2 * b * b * b;
  }
  return A.partialPivLu().solve(B);
}

/// Cubic from x = 0 to h by values and slopes at its ends.
template <typename T>
std::array<T, 4> cubic(const T& y0, const T& s0, const T& y1, const T& s1, double h) {
  const T d = (y1 - y0) / h;
  return {y0, s0, (3 * d - 2 * s0 - s1) / h, (s0 + s1 - 2 * d) / (h * h)};
}

/// Straight on from the end of the last cubic.
template <typename T>
std::array<T, 4> straight(const std::array<T, 4>& c, double x) {
  const T zero = 0 * c[0];
  return {c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2 * c[2] + 3 * x * c[3]), zero, zero};
}

/// The cubics of one way, besides those that go straight on; `at(k)`, `slope(k)`: at its knots.
struct Pieces {
  std::vector<double> breaks, origins;
  explicit Pieces(const std::vector<double>& x) {
    const double more = kMostBeyond * (x.back() - x.front());
    breaks = x;
    breaks.front() -= more;
    breaks.back() += more;
    origins = {breaks.front()};
    origins.insert(origins.end(), x.begin(), x.end() - 1);
    origins.push_back(breaks.back());
  }
};

}  // namespace

TensorSpline::TensorSpline(std::vector<double> u, std::vector<double> v, const std::vector<Vec3>& points)
    : u_(std::move(u)), v_(std::move(v)) {
  const auto rows = Eigen::Index(u_.size()), columns = Eigen::Index(v_.size());
  const Matrix Mu = slopes_of(u_), Mv = slopes_of(v_);
  std::array<Matrix, 3> P, Pu, Pv, Puv;
  for (int k = 0; k < 3; ++k) {
    auto& p = P[std::size_t(k)];
    p.resize(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < columns; ++j) p(i, j) = points[std::size_t(i * columns + j)][k];
    Pu[std::size_t(k)] = Mu * p;
    Pv[std::size_t(k)] = p * Mv.transpose();
    Puv[std::size_t(k)] = Mu * Pv[std::size_t(k)];
  }
  const auto at = [](const std::array<Matrix, 3>& m, Eigen::Index i, Eigen::Index j) {
    return Vec3(m[0](i, j), m[1](i, j), m[2](i, j));
  };
  const Pieces along_u(u_), along_v(v_);
  break_u_ = along_u.breaks;
  break_v_ = along_v.breaks;
  origin_u_ = along_u.origins;
  origin_v_ = along_v.origins;
  const std::size_t in_u = origin_u_.size(), in_v = origin_v_.size();
  patches_.resize(in_u * in_v);
  const auto patch = [&](std::size_t i, std::size_t j) -> Patch& { return patches_[i * in_v + j]; };
  for (Eigen::Index i = 0; i + 1 < rows; ++i)
    for (Eigen::Index j = 0; j + 1 < columns; ++j) {
      const double h = u_[std::size_t(i) + 1] - u_[std::size_t(i)], w = v_[std::size_t(j) + 1] - v_[std::size_t(j)];
      // Along v at both rows, values and slopes by u; then along u for each power of v.
      std::array<std::array<Vec3, 4>, 2> value, slope;
      for (Eigen::Index e = 0; e < 2; ++e) {
        value[std::size_t(e)] = cubic(at(P, i + e, j), at(Pv, i + e, j), at(P, i + e, j + 1), at(Pv, i + e, j + 1), w);
        slope[std::size_t(e)] =
            cubic(at(Pu, i + e, j), at(Puv, i + e, j), at(Pu, i + e, j + 1), at(Puv, i + e, j + 1), w);
      }
      Patch& c = patch(std::size_t(i) + 1, std::size_t(j) + 1);
      for (std::size_t b = 0; b < 4; ++b) {
        const auto column = cubic(value[0][b], slope[0][b], value[1][b], slope[1][b], h);
        for (std::size_t a = 0; a < 4; ++a) c[a][b] = column[a];
      }
    }
  // Straight on at the four sides, and in the corners.
  for (const bool high : {false, true}) {
    const std::size_t from = high ? in_v - 2 : 1, to = high ? in_v - 1 : 0;
    for (std::size_t i = 1; i + 1 < in_u; ++i)
      for (std::size_t a = 0; a < 4; ++a)
        patch(i, to)[a] = straight(patch(i, from)[a], origin_v_[to] - origin_v_[from]);
  }
  for (const bool high : {false, true}) {
    const std::size_t from = high ? in_u - 2 : 1, to = high ? in_u - 1 : 0;
    for (std::size_t j = 0; j < in_v; ++j)
      for (std::size_t b = 0; b < 4; ++b) {
        std::array<Vec3, 4> column;
        for (std::size_t a = 0; a < 4; ++a) column[a] = patch(from, j)[a][b];
        column = straight(column, origin_u_[to] - origin_u_[from]);
        for (std::size_t a = 0; a < 4; ++a) patch(to, j)[a][b] = column[a];
      }
  }
}

}  // namespace toothpath::flank_grid
