// Linear programs with at most four variables and any number of rows: the rows stay where they are, only those that
// rule are held.
#pragma once

#include <array>
#include <functional>
#include <optional>

namespace toothpath::numbers {

/// a . x <= b
struct LinearRow {
  std::array<double, 4> a{};
  double b = 0;
};

using LinearPoint = std::array<double, 4>;

/// Maximizes objective . x over |x_i| <= box and all rows, by generation of constraints: the vertex of the rows held so
/// far, then the row that it breaks most, until it breaks none by more than `tolerance`. Every vertex is found by
/// trying all sets of rows that meet in it, so that degenerate rows do no harm.
/// @param variables 1 to 4; @param most_broken the row with the greatest a . x - b
/// Empty: no point keeps the rows, or 400 steps were not enough.
[[nodiscard]] std::optional<LinearPoint> maximize(int variables, const LinearPoint& objective, double box,
                                                  const std::function<LinearRow(const LinearPoint&)>& most_broken,
                                                  double tolerance = 1e-9);

}  // namespace toothpath::numbers
