#include "cam/line/smooth.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace toothpath::line {

std::vector<double> smoothed(const std::vector<double>& y, double stiffness) {
  const auto n = Eigen::Index(y.size());
  if (n < 4 || stiffness == 0) return y;
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  const Eigen::Vector4d third(-1, 3, -3, 1);
  for (Eigen::Index k = 0; k + 3 < n; ++k) A.block<4, 4>(k, k) += stiffness * third * third.transpose();
  const Eigen::VectorXd z = A.ldlt().solve(Eigen::Map<const Eigen::VectorXd>(y.data(), n));
  return {z.data(), z.data() + n};
}

double StationCurve::slope(std::size_t k) const {
  const std::size_t a = k > 0 ? k - 1 : k, b = std::min(k + 1, y_.size() - 1);
  return b > a ? (y_[b] - y_[a]) / double(b - a) : 0;
}

double StationCurve::at(double x) const {
  const double u = (x - start_) / step_, last = double(y_.size() - 1);
  if (u <= 0) return y_.front() + u * slope(0);
  if (u >= last) return y_.back() + (u - last) * slope(y_.size() - 1);
  const auto k = std::min(std::size_t(u), y_.size() - 2);
  const double s = u - double(k), w = 1 - s;
  return w * w * (1 + 2 * s) * y_[k] + s * s * (3 - 2 * s) * y_[k + 1] + s * w * (w * slope(k) - s * slope(k + 1));
}

}  // namespace toothpath::line
