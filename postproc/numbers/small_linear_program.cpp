#include "postproc/numbers/small_linear_program.h"

#include <cmath>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::numbers {
namespace {

constexpr int kMostSteps = 400;
constexpr std::size_t kHeld = 28;  // rows; beyond it those that do not meet in the vertex are let go
constexpr double kLeastPivot = 1e-10;

double excess(const LinearRow& r, const LinearPoint& x) {
  return r.a[0] * x[0] + r.a[1] * x[1] + r.a[2] * x[2] + r.a[3] * x[3] - r.b;
}

/// Where `n` rows meet; empty where they do not in one point.
std::optional<LinearPoint> meet(int n, const std::array<const LinearRow*, 4>& rows) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) m(i, j) = rows[static_cast<std::size_t>(i)]->a[static_cast<std::size_t>(j)];
    b[i] = rows[static_cast<std::size_t>(i)]->b;
  }
  if (std::abs(m.determinant()) < kLeastPivot) return std::nullopt;
  const Eigen::Vector4d x = m.partialPivLu().solve(b);
  return LinearPoint{x[0], x[1], x[2], x[3]};
}

class Program {
 public:
  Program(int n, const LinearPoint& objective, double box, double tolerance)
      : n_(n), objective_(objective), tolerance_(tolerance) {
    for (int i = 0; i < n; ++i)
      for (const double side : {1.0, -1.0}) {
        LinearRow r;
        r.a[static_cast<std::size_t>(i)] = side;
        r.b = box;
        rows_.push_back(r);
      }
    for (int i = 0; i < n; ++i)
      x_[static_cast<std::size_t>(i)] = objective[static_cast<std::size_t>(i)] >= 0 ? box : -box;
  }
  const LinearPoint& point() const { return x_; }

  /// The best vertex in which `row` meets others; false: there is none.
  bool add(const LinearRow& row) {
    if (rows_.size() > kHeld) let_go();
    rows_.push_back(row);
    best_.reset();
    chosen_[0] = &rows_.back();
    choose(1, 0);
    if (!best_) return false;
    x_ = *best_;
    return true;
  }

 private:
  double value(const LinearPoint& x) const {
    return objective_[0] * x[0] + objective_[1] * x[1] + objective_[2] * x[2] + objective_[3] * x[3];
  }
  /// Rows that do not meet in the vertex; the box stays.
  void let_go() {
    std::vector<LinearRow> kept(rows_.begin(), rows_.begin() + 2 * n_);
    for (std::size_t i = kept.size(); i < rows_.size(); ++i)
      if (excess(rows_[i], x_) >= -1e-7) kept.push_back(rows_[i]);
    rows_ = std::move(kept);
  }
  void choose(int depth, std::size_t from) {
    if (depth == n_) {
      const auto x = meet(n_, chosen_);
      if (!x || (best_ && value(*x) <= value(*best_))) return;
      for (const auto& r : rows_)
        if (excess(r, *x) > tolerance_) return;
      best_ = x;
      return;
    }
    for (std::size_t i = from; i + 1 < rows_.size(); ++i) {
      chosen_[static_cast<std::size_t>(depth)] = &rows_[i];
      choose(depth + 1, i + 1);
    }
  }

  int n_;
  LinearPoint objective_, x_{};
  double tolerance_;
  std::vector<LinearRow> rows_;
  std::array<const LinearRow*, 4> chosen_{};
  std::optional<LinearPoint> best_;
};

}  // namespace

std::optional<LinearPoint> maximize(int variables, const LinearPoint& objective, double box,
                                    const std::function<LinearRow(const LinearPoint&)>& most_broken, double tolerance) {
  Program program(variables, objective, box, 0.1 * tolerance);
  for (int step = 0; step < kMostSteps; ++step) {
    const LinearRow row = most_broken(program.point());
    if (excess(row, program.point()) <= tolerance) return program.point();
    if (!program.add(row)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace toothpath::numbers
