// A solution followed while what it belongs to moves on.
#pragma once

#include <optional>

namespace toothpath {

/// What solves at `to`, from what does at `from`; where that start is too far off, in halves of the way.
/// @param by     about how the solution grows
/// @param solve  (start, at) -> std::optional of the solution there
template <typename T, typename Solve>
std::optional<T> followed(const T& start, double from, double to, const T& by, const Solve& solve, int halvings = 6) {
  const auto there = solve(T(start + (to - from) * by), to);
  if (there || halvings == 0 || to == from) return there;
  const double middle = 0.5 * (from + to);
  const auto half = followed<T>(start, from, middle, by, solve, halvings - 1);
  return half ? followed<T>(*half, middle, to, by, solve, halvings - 1) : std::nullopt;
}

}  // namespace toothpath
