// Functions of one number, polynomial in pieces and C1: what flank modifications are made of.
//
// Beyond its ends a curve goes on along its tangent. Arguments may be any scalar of the kernels: double, more digits,
// intervals (the result holds every value, derivatives where pieces meet included), and duals of these.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/base/dual.h"
#include "geometry/base/interval.h"

namespace toothpath::modification {

class SmoothCurve {
 public:
  static constexpr std::size_t kMostTerms = 7;
  /// sum c[k] (x - origin)^k
  struct Piece {
    double origin = 0;
    std::array<double, kMostTerms> c{};
  };

  /// The constant.
  explicit SmoothCurve(double value = 0) : knots_{0, 1}, pieces_{Piece{0, {value}}} {}
  /// Piece k holds between knots k and k + 1. Knots rise; value and slope agree where pieces meet: the maker's duty.
  SmoothCurve(std::vector<double> knots, std::vector<Piece> pieces)
      : knots_(std::move(knots)), pieces_(std::move(pieces)) {}

  /// The natural cubic spline through (x[k], y[k]); x rises, at least 2.
  [[nodiscard]] static SmoothCurve spline(const std::vector<double>& x, const std::vector<double>& y);
  /// The cubics with these values and slopes at x, which rises, at least 2.
  [[nodiscard]] static SmoothCurve hermite(std::vector<double> x, const std::vector<double>& y,
                                           const std::vector<double>& slopes);
  /// The curve turned over: value at x as before at sum - x.
  [[nodiscard]] SmoothCurve mirrored(double sum) const;
  [[nodiscard]] SmoothCurve times(double factor) const;

  template <typename S>
  [[nodiscard]] S operator()(const S& x) const {
    return derivative(x, 0);
  }
  /// The derivative of this order, 0 the value. Where two pieces meet that of the right one.
  template <typename S>
  [[nodiscard]] S derivative(const S& x, std::size_t order) const {
    if (x < S(knots_.front())) return beyond(S(x - S(knots_.front())), knots_.front(), pieces_.front(), order);
    if (x > S(knots_.back())) return beyond(S(x - S(knots_.back())), knots_.back(), pieces_.back(), order);
    std::size_t low = 0, high = pieces_.size();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (x < S(knots_[middle]) ? high : low) = middle;
    }
    return polynomial(pieces_[low], S(x - S(pieces_[low].origin)), order);
  }
  template <typename S, int N>
  [[nodiscard]] Dual<S, N> derivative(const Dual<S, N>& x, std::size_t order) const {
    return x.chain(derivative(x.v, order), derivative(x.v, order + 1));
  }
  /// Over an interval: the hull of the pieces that it touches.
  [[nodiscard]] Interval derivative(const Interval& x, std::size_t order) const;

  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }
  /// Where the last piece that bends ends; the first knot where none does.
  [[nodiscard]] double bent_to() const;

 private:
  template <typename S>
  static S polynomial(const Piece& p, const S& t, std::size_t order) {
    S sum(0);
    for (std::size_t k = kMostTerms; k-- > order;) {
      double factor = p.c[k];
      for (std::size_t n = 0; n < order; ++n) factor *= double(k - n);
      sum = sum * t + S(factor);
    }
    return sum;
  }
  /// Along the tangent at the end, `off` from it.
  template <typename S>
  static S beyond(const S& off, double end, const Piece& p, std::size_t order) {
    const S at(end - p.origin);
    if (order > 1) return S(0);
    const S slope = polynomial(p, at, 1);
    return order == 1 ? slope : S(polynomial(p, at, 0) + slope * off);
  }

  std::vector<double> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace toothpath::modification
