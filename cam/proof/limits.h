// What a program must keep, and how exactly that is proven.
#pragma once

#include <optional>

#include "cam/path/operation.h"

namespace toothpath::proof {

/// Rounding, axis motion and the grid of the measurement with ball mills, beside cusps and chords.
inline constexpr double kBallMargin = 1e-3;  // mm
/// What an operation may leave above its allowance on every place of a region that its tool can reach, mm: the cusps of
/// a ball or the misfit of a side, the chords and the margin.
[[nodiscard]] inline double most_left_mm(const path::MillingOperation& o, path::Region region) {
  const double form = o.type == path::OperationType::line_milling ? o.most_misfit_mm() : o.scallop_in(region);
  return form + o.chord_tolerance_mm + kBallMargin;
}

/// Made once from a job (app/process/proof_limits.h) and handed to whoever plans, checks or judges. All in mm.
struct ProofLimits {
  double gouge_mm = 2e-3;         ///< deepest cut into the finished surface that still counts as verified
  double proof_mm = 2e-4;         ///< how far a proven bound may lie above the worst value measured
  double clearance_mm = 0.05;     ///< least gap between neck, shank or holder and the part
  std::optional<double> left_mm;  ///< most that may stand on the finished surface after the last operation; none:
                                  ///< nothing finishes it. Of face gears the largest of all regions
  path::ByRegion<std::optional<double>> left_in_mm;  ///< the same for each region of a face gear
};

}  // namespace toothpath::proof
