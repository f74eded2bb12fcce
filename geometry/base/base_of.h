// What a scalar of the kernels stands on: a number of any precision, or an interval, below all derivatives.
#pragma once

#include <type_traits>
#include <utility>

#include "geometry/base/dual.h"
#include "geometry/base/interval.h"

namespace toothpath {

/// The number or interval below all derivatives, and how many times derivatives are taken above it.
template <typename T>
const T& base_of(const T& x) {
  return x;
}
template <typename T, int N>
const auto& base_of(const Dual<T, N>& x) {
  return base_of(x.v);
}
template <typename S>
inline constexpr int kDepth = 0;
template <typename T, int N>
inline constexpr int kDepth<Dual<T, N>> = 1 + kDepth<T>;
template <typename S>
using BaseOf = std::remove_cvref_t<decltype(base_of(std::declval<const S&>()))>;

/// Intervals and their duals: no branch holds for all that they stand for.
template <typename S>
inline constexpr bool kEncloses = std::is_same_v<BaseOf<S>, Interval>;

}  // namespace toothpath
