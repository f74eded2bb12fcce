// A small linear programme: least c.x over rows a.x >= b, by exchanging one active row at a time (dual simplex; on a
// discrete Chebyshev problem it is the exchange algorithm of Stiefel and Remez).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace toothpath::line {

inline constexpr int kUnknowns = 4;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

struct LinearRow {
  Unknowns a;
  double b = 0;
};

/// The x with least x[3] over the rows and the box |x_k| <= box_k (all box_k > 0). Rows hold to 1e-13 of their b's unit
/// at the answer. Nothing where no x fulfils all rows, or after 500 exchanges (each lowers the dual strictly but for
/// ties).
[[nodiscard]] std::optional<Unknowns> least_last(const std::vector<LinearRow>& rows, const Unknowns& box);

}  // namespace toothpath::line
