// What a program must keep, and how exactly that is proven.
#pragma once

#include <optional>

namespace toothpath::proof {

/// Made once from a job (app/process/proof_limits.h) and handed to whoever plans, checks or judges. All in mm.
struct ProofLimits {
  double gouge_mm = 2e-3;         ///< deepest cut into the finished surface that still counts as verified
  double proof_mm = 2e-4;         ///< how far a proven bound may lie above the worst value measured
  double clearance_mm = 0.05;     ///< least gap between neck, shank or holder and the part
  std::optional<double> left_mm;  ///< most that may stand on the finished surface after the last operation; none: nothing finishes it
};

}  // namespace toothpath::proof
