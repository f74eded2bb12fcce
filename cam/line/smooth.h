// Values on evenly spaced stations made smooth: the smoothest ones that stay near, and a curve through them.
#pragma once

#include <vector>

namespace toothpath::line {

/// z with least sum (y - z)^2 + stiffness sum (third difference of z)^2. At least four values; fewer are returned as
/// they are. stiffness 0: y itself; the larger, the nearer to a parabola. Source: Whittaker 1922, graduation by
/// differences.
[[nodiscard]] std::vector<double> smoothed(const std::vector<double>& y, double stiffness);

/// A curve through values at start, start + step, ..: cubic between four neighbours (slopes by central differences),
/// one continuous derivative, straight beyond its ends.
class StationCurve {
 public:
  StationCurve() = default;
  StationCurve(double start, double step, std::vector<double> values)
      : start_(start), step_(step), y_(std::move(values)) {}
  [[nodiscard]] double at(double x) const;

 private:
  [[nodiscard]] double slope(std::size_t k) const;  ///< per step
  double start_ = 0, step_ = 1;
  std::vector<double> y_;
};

}  // namespace toothpath::line
