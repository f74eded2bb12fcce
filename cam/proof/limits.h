// What a program must keep, and how exactly that is proven.
#pragma once

#include <optional>

#include "cam/path/operation.h"

namespace toothpath::proof {

/// Rounding, axis motion and the grid of the measurement with ball mills, beside cusps and chords.
inline constexpr double kBallMargin = 1e-3;  // mm
/// What an operation of a ball mill may leave above its allowance on every place that its ball can reach, mm.
[[nodiscard]] inline double most_left_mm(const path::MillingOperation& o) {
  return o.scallop_mm + o.chord_tolerance_mm + kBallMargin;
}

/// Made once from a job (app/process/proof_limits.h) and handed to whoever plans, checks or judges. All in mm.
struct ProofLimits {
  double gouge_mm = 2e-3;      ///< deepest cut into the finished surface that still counts as verified
  double proof_mm = 2e-4;      ///< how far a proven bound may lie above the worst value measured
  double clearance_mm = 0.05;  ///< least gap between neck, shank or holder and the part
  std::optional<double>
      left_mm;  ///< most that may stand on the finished surface after the last operation; none: nothing finishes it
};

}  // namespace toothpath::proof
