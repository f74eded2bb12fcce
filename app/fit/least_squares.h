// Least squares with bounds, minimised by Ceres. Ceres and what it needs are two dozen shared libraries: they stand
// behind a library of our own, which is opened when the first problem is minimised, so that no other command pays for
// them.
#pragma once

#include "geometry/base/result.h"

namespace toothpath::fit {

/// Minimises half the sum of r_i(x)^2 over low <= x <= high. Plain C across the library's border.
struct LeastSquares {
  int parameters = 0, residuals = 0;
  double* x = nullptr;                           ///< start, within the bounds; then the end
  const double *low = nullptr, *high = nullptr;  ///< of every parameter
  /// Residuals and, where asked, their derivatives, one row a residual. False: there is nothing at this x.
  bool (*evaluate)(void* who, const double* x, double* residuals, double* jacobian) = nullptr;
  void* who = nullptr;
  int most_steps = 0;
  bool settled = false;  ///< the end is a minimum as far as double numbers tell
  int steps = 0;
};

/// Errors (kind file_access): the library is missing or does not fit.
[[nodiscard]] Status minimise(LeastSquares& problem);

}  // namespace toothpath::fit
