// Are the cuts of one tooth made again on another? What is not cut there stays standing, and nothing is gouged by it.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cam/path/tool_motion.h"

namespace toothpath::proof {

/// How the cuts of a first tooth are made again on a later one.
struct CutsAgain {
  /// No place of a cut of the first tooth is farther from where the later tooth's tool comes, turned: mm, rad. What is
  /// missing is not counted here.
  double tip_mm = 0, axis_rad = 0;
  /// A cut that is not made again within 0.1 mm.
  struct Missing {
    int line = 0;  ///< of the first tooth
    int behind_line =
        0;  ///< of the later one: where the last cut before it was made again, in order; else its first one
    double off_mm =
        std::numeric_limits<double>::infinity();  ///< of the tip on it, at most, from the nearest cut of the later one
  };
  std::optional<Missing> missing;  ///< the first of them; behind it nothing was looked for

  /// How much more may stand on the later tooth where the tool reaches `arm_mm` above its tip.
  [[nodiscard]] double away(double arm_mm) const {
    return missing ? std::numeric_limits<double>::infinity() : tip_mm + arm_mm * axis_rad;
  }
};

/// A first tooth of an operation, and which of its motions may cut: what cannot need not be made again. It is asked of
/// a motion only where that decides, and once.
class FirstTooth {
 public:
  using MayCut = std::function<bool(const path::ToolMotion&)>;
  FirstTooth(std::vector<path::ToolMotion> motions, MayCut may_cut);
  [[nodiscard]] std::span<const path::ToolMotion> motions() const { return motions_; }
  [[nodiscard]] bool may_cut(std::size_t k) const;

 private:
  std::vector<path::ToolMotion> motions_;
  MayCut may_cut_;
  mutable std::vector<std::atomic<signed char>> known_;  ///< -1: not yet
};

/// The feed motions of a first tooth looked for among those of a later one, however either is cut into blocks.
/// @param turn  about the gear axis, from the first tooth to the later one, rad
[[nodiscard]] CutsAgain cuts_again(const FirstTooth& first, std::span<const path::ToolMotion> later, double turn);

}  // namespace toothpath::proof
