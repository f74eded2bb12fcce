// Forward automatic differentiation: a value and its N first derivatives.
// Enough arithmetic for the flank kernels; derivatives are exact to rounding.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace toothpath {

template <typename S, int N>
struct Dual {
  S v{};
  std::array<S, N> d{};

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: constants mix freely with duals
  static Dual variable(const S& value, int index) {
    Dual x;
    x.v = value;
    x.d[static_cast<std::size_t>(index)] = S(1);
    return x;
  }
  /// f(x) with f' given: the chain rule.
  [[nodiscard]] Dual chain(const S& f, const S& df) const {
    Dual r;
    r.v = f;
    for (int k = 0; k < N; ++k) r.d[std::size_t(k)] = df * d[std::size_t(k)];
    return r;
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  [[gnu::always_inline]] friend Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v + b.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = a.d[k] + b.d[k];
    return r;
  }
  [[gnu::always_inline]] friend Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v - b.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = a.d[k] - b.d[k];
    return r;
  }
  [[gnu::always_inline]] friend Dual operator-(const Dual& a) {
    Dual r;
    r.v = -a.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = -a.d[k];
    return r;
  }
  [[gnu::always_inline]] friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = a.d[k] * b.v + a.v * b.d[k];
    return r;
  }
  [[gnu::always_inline]] friend Dual operator/(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v / b.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = (a.d[k] - r.v * b.d[k]) / b.v;
    return r;
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.v == b.v; }

  friend Dual sin(const Dual& a) {
    using std::sin, std::cos;
    return a.chain(sin(a.v), cos(a.v));
  }
  friend Dual cos(const Dual& a) {
    using std::sin, std::cos;
    return a.chain(cos(a.v), S(-sin(a.v)));
  }
  friend Dual tan(const Dual& a) {
    using std::tan;
    const S t = tan(a.v);
    return a.chain(t, S(S(1) + t * t));
  }
  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const S r = sqrt(a.v);
    return a.chain(r, S(S(1) / (S(2) * r)));
  }
  friend Dual atan(const Dual& a) {
    using std::atan;
    return a.chain(atan(a.v), S(S(1) / (S(1) + a.v * a.v)));
  }
  friend Dual acos(const Dual& a) {
    using std::acos, std::sqrt;
    return a.chain(acos(a.v), S(S(-1) / sqrt(S(S(1) - a.v * a.v))));
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    Dual r;
    r.v = atan2(y.v, x.v);
    const S n = x.v * x.v + y.v * y.v;
    for (std::size_t k = 0; k < N; ++k) r.d[k] = (x.v * y.d[k] - y.v * x.d[k]) / n;
    return r;
  }
};

/// The vector without its derivatives, and its derivative by variable k.
template <typename S, int N>
[[nodiscard]] Eigen::Matrix<S, 3, 1> value(const Eigen::Matrix<Dual<S, N>, 3, 1>& x) {
  return {x[0].v, x[1].v, x[2].v};
}
template <typename S, int N>
[[nodiscard]] Eigen::Matrix<S, 3, 1> derivative(const Eigen::Matrix<Dual<S, N>, 3, 1>& x, std::size_t k) {
  return {x[0].d[k], x[1].d[k], x[2].d[k]};
}

}  // namespace toothpath

template <typename S, int N>
struct Eigen::NumTraits<toothpath::Dual<S, N>> : Eigen::NumTraits<S> {
  using Real = toothpath::Dual<S, N>;
  using NonInteger = toothpath::Dual<S, N>;
  using Nested = toothpath::Dual<S, N>;
  using Literal = toothpath::Dual<S, N>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = N,
    MulCost = 2 * N
  };
};
