// Derivatives of a function that are known at a place, or enclosed over a box, put into the chain rule of any scalar:
// dual numbers, intervals of dual numbers of dual numbers.
#pragma once

#include <algorithm>
#include <array>

#include "geometry/base/base_of.h"
#include "geometry/base/vec.h"

namespace toothpath::flank_grid {

inline constexpr int kMostOrder = 3;

/// d[i][j]: derivative of a place by u, i times, and by v, j times; i + j <= order.
template <typename B>
struct Partials {
  std::array<std::array<Vec3T<B>, kMostOrder + 1>, kMostOrder + 1> d;
};
template <typename B>
Vec3T<B> lifted(const Partials<B>& f, const B&, const B&, std::size_t i, std::size_t j) {
  return f.d[i][j];
}
template <typename B, typename T, int N>
Vec3T<Dual<T, N>> lifted(const Partials<B>& f, const Dual<T, N>& u, const Dual<T, N>& v, std::size_t i, std::size_t j) {
  const Vec3T<T> p = lifted(f, u.v, v.v, i, j), pu = lifted(f, u.v, v.v, i + 1, j), pv = lifted(f, u.v, v.v, i, j + 1);
  Vec3T<Dual<T, N>> out;
  for (int k = 0; k < 3; ++k) {
    out[k].v = p[k];
    for (std::size_t n = 0; n < N; ++n) out[k].d[n] = pu[k] * u.d[n] + pv[k] * v.d[n];
  }
  return out;
}

/// d[i][k]: derivative i of number k of a curve.
template <typename B, std::size_t K>
struct CurveDerivatives {
  std::array<std::array<B, K>, kMostOrder + 1> d;
};
template <typename B, std::size_t K>
B lifted(const CurveDerivatives<B, K>& f, const B&, std::size_t i, std::size_t k) {
  return f.d[i][k];
}
template <typename B, std::size_t K, typename T, int N>
Dual<T, N> lifted(const CurveDerivatives<B, K>& f, const Dual<T, N>& v, std::size_t i, std::size_t k) {
  Dual<T, N> out;
  out.v = lifted(f, v.v, i, k);
  const T slope = lifted(f, v.v, i + 1, k);
  for (std::size_t n = 0; n < N; ++n) out.d[n] = slope * v.d[n];
  return out;
}

/// A derivative of c0 + c1 x + c2 x^2 + c3 x^3.
template <typename B>
B cubic_derivative(const std::array<B, 4>& c, const B& x, int order) {
  switch (order) {
    case 0: return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
    case 1: return c[1] + x * (B(2.0) * c[2] + x * (B(3.0) * c[3]));
    case 2: return B(2.0) * c[2] + x * (B(6.0) * c[3]);
    case 3: return B(6.0) * c[3];
    default: return B(0.0);
  }
}

/// Numbers have no hull, and a place lies in one piece alone.
inline void widen(double& into, double x) { into = x; }
inline void widen(Interval& into, const Interval& x) { into = hull(into, x); }
inline double low_of(double x) { return x; }
inline double low_of(const Interval& x) { return x.low; }
inline double high_of(double x) { return x; }
inline double high_of(const Interval& x) { return x.high; }
inline double within(double x, double, double) { return x; }
inline Interval within(const Interval& x, double from, double to) {
  return {std::max(x.low, from), std::min(x.high, to)};
}

}  // namespace toothpath::flank_grid
