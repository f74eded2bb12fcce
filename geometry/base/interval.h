// Interval arithmetic with outward rounding: what a formula can become when its arguments range over boxes.
//
// Every operation returns an interval that holds the result for every choice of arguments, rounding included: ends are
// moved outwards by a unit in the last place or more. Sine, cosine, arc functions and roots of the C library are taken
// as right to two units in the last place. Source: R. E. Moore, Interval Analysis, 1966.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath {

struct Interval {
  double low = 0, high = 0;

  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT: constants mix freely with intervals
  Interval(double from, double to) : low(from), high(to) {}
  /// All numbers: the result where a formula has none.
  static Interval whole() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  /// [from, to] moved outwards by `units` in the last place of the larger one; everything where an end is no number.
  static Interval outwards(double from, double to, double units = 1) {
    if (std::isnan(from) || std::isnan(to)) return whole();
    constexpr double unit = 2.3e-16, least = std::numeric_limits<double>::denorm_min();
    return {from - (units * unit * std::abs(from) + least), to + (units * unit * std::abs(to) + least)};
  }

  [[nodiscard]] double middle() const { return 0.5 * low + 0.5 * high; }
  /// Half the width, never too small.
  [[nodiscard]] double radius() const {
    const double m = middle();
    return std::max(high - m, m - low) * (1 + 4e-16);
  }
  [[nodiscard]] double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
  [[nodiscard]] bool holds(double x) const { return low <= x && x <= high; }
  [[nodiscard]] bool finite() const { return std::isfinite(low) && std::isfinite(high); }

  Interval& operator+=(const Interval& b) { return *this = *this + b; }
  Interval& operator-=(const Interval& b) { return *this = *this - b; }
  Interval& operator*=(const Interval& b) { return *this = *this * b; }
  Interval& operator/=(const Interval& b) { return *this = *this / b; }

  friend Interval operator+(const Interval& a, const Interval& b) { return outwards(a.low + b.low, a.high + b.high); }
  friend Interval operator-(const Interval& a, const Interval& b) { return outwards(a.low - b.high, a.high - b.low); }
  friend Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
  friend Interval operator*(const Interval& a, const Interval& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    if (std::isnan(p + q + r + s)) return whole();
    return outwards(std::min({p, q, r, s}), std::max({p, q, r, s}));
  }
  friend Interval operator/(const Interval& a, const Interval& b) {
    if (!(b.low > 0) && !(b.high < 0)) return whole();
    const double p = a.low / b.low, q = a.low / b.high, r = a.high / b.low, s = a.high / b.high;
    return outwards(std::min({p, q, r, s}), std::max({p, q, r, s}));
  }
  /// True only where it holds for every choice.
  friend bool operator<(const Interval& a, const Interval& b) { return a.high < b.low; }
  friend bool operator>(const Interval& a, const Interval& b) { return a.low > b.high; }
  friend bool operator<=(const Interval& a, const Interval& b) { return a.high <= b.low; }
  friend bool operator>=(const Interval& a, const Interval& b) { return a.low >= b.high; }
  friend bool operator==(const Interval& a, const Interval& b) { return a.low == b.low && a.high == b.high; }

  friend Interval hull(const Interval& a, const Interval& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
  }
  friend Interval sqrt(const Interval& a) {
    if (!(a.low >= 0)) return whole();
    const Interval r = outwards(std::sqrt(a.low), std::sqrt(a.high), 2);
    return {std::max(r.low, 0.0), r.high};
  }
  friend Interval cos(const Interval& a) {
    constexpr double turn = 6.283185307179586476925286766559, slack = 1e-9;
    if (!(a.high - a.low < turn) || a.magnitude() > 1e6) return {-1, 1};
    const double c0 = std::cos(a.low), c1 = std::cos(a.high);
    Interval r = outwards(std::min(c0, c1), std::max(c0, c1), 4);
    // A top at 2 k pi, a bottom at (2 k + 1) pi: taken as inside also where it lies 1e-9 beside.
    const auto passes = [&](double at) {
      return std::floor((a.high - at + slack) / turn) >= std::ceil((a.low - at - slack) / turn);
    };
    if (passes(0)) r.high = 1;
    if (passes(0.5 * turn)) r.low = -1;
    return {std::max(r.low, -1.0), std::min(r.high, 1.0)};
  }
  friend Interval sin(const Interval& a) {
    constexpr double quarter = 1.5707963267948966192313216916398;
    return cos(a - Interval(quarter, std::nextafter(quarter, 2.0)));
  }
  friend Interval tan(const Interval& a) { return sin(a) / cos(a); }
  friend Interval atan(const Interval& a) { return outwards(std::atan(a.low), std::atan(a.high), 4); }
  friend Interval acos(const Interval& a) {
    if (!(a.low >= -1 && a.high <= 1)) return whole();
    return outwards(std::acos(a.high), std::acos(a.low), 4);
  }
  /// Boxes that hold the origin or touch the negative x axis have no single angle.
  friend Interval atan2(const Interval& y, const Interval& x) {
    if (!(x.low > 0) && !(y.low > 0) && !(y.high < 0)) return whole();
    const double p = std::atan2(y.low, x.low), q = std::atan2(y.low, x.high), r = std::atan2(y.high, x.low),
                 s = std::atan2(y.high, x.high);
    return outwards(std::min({p, q, r, s}), std::max({p, q, r, s}), 4);
  }
};

}  // namespace toothpath

template <>
struct Eigen::NumTraits<toothpath::Interval> : Eigen::NumTraits<double> {
  using Real = toothpath::Interval;
  using NonInteger = toothpath::Interval;
  using Nested = toothpath::Interval;
  using Literal = toothpath::Interval;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 4,
    MulCost = 10
  };
};
