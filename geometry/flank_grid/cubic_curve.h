// Some numbers over a parameter as cubics, one behind the other: at a place or enclosed over a range.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/flank_grid/lifted.h"

namespace toothpath::flank_grid {

/// K numbers. The first and the last cubic have no end.
template <std::size_t K>
class CubicCurve {
 public:
  using Cubic = std::array<double, 4>;  ///< c0 + c1 x + c2 x^2 + c3 x^3 from the beginning of the piece

  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }
  void begin(double at) { breaks_ = {at}; }
  /// The next piece, up to `to`.
  std::array<Cubic, K>& add(double to) {
    breaks_.push_back(to);
    return cubics_.emplace_back();
  }
  /// Adds to a number everywhere.
  void shift(std::size_t number, double by) {
    for (auto& cubics : cubics_) cubics[number][0] += by;
  }
  /// Of the numbers from one to before another.
  template <typename B>
  [[nodiscard]] CurveDerivatives<B, K> derivatives(const B& v, int order, std::size_t begin, std::size_t end) const {
    CurveDerivatives<B, K> out;
    const auto piece = [&](double x) {
      const auto k = std::upper_bound(breaks_.begin(), breaks_.end(), x) - breaks_.begin();
      return std::size_t(std::clamp<std::ptrdiff_t>(k, 1, std::ptrdiff_t(breaks_.size()) - 1)) - 1;
    };
    const std::size_t first = piece(low_of(v)), last = piece(high_of(v));
    for (std::size_t i = first; i <= last; ++i) {
      const B x = within(v, i == first ? -INFINITY : breaks_[i], i == last ? INFINITY : breaks_[i + 1]) - B(breaks_[i]);
      for (std::size_t k = begin; k < end; ++k) {
        const auto& c = cubics_[i][k];
        for (int a = 0; a <= order; ++a) {
          const B y = cubic_derivative<B>({B(c[0]), B(c[1]), B(c[2]), B(c[3])}, x, a);
          if (i == first) out.d[std::size_t(a)][k] = y;
          else widen(out.d[std::size_t(a)][k], y);
        }
      }
    }
    return out;
  }

 private:
  std::vector<double> breaks_;
  std::vector<std::array<Cubic, K>> cubics_;
};

}  // namespace toothpath::flank_grid
