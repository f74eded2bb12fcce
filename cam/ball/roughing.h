// Roughing of one tooth space with a ball: layers parallel to the root, passes along the tooth, climb on both walls.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cam/ball/finishing.h"
#include "cam/cut/swept_tool.h"
#include "geometry/base/refusal.h"

namespace toothpath::ball {

struct RoughingOptions {
  double ball_radius_mm = 0;
  double allowance_mm = 0;
  double step_down_mm = 0;
  double step_over_mm = 0;
  double chord_mm = 0;
  double end_centre_mm =
      0;  ///< height above the tip of the centre that is planned: the ball's radius, less for flatter ends
  double overrun_mm = 0;    ///< beyond both ends of the ring, for the ball centre
  double blank_top_mm = 0;  ///< height of the blank at the middle of the ring
  bool climb = true;
};

struct RoughingPasses {
  std::vector<BallPass> passes;  ///< in cutting order, from the top layer down
  int layers = 0, skipped = 0;   ///< passes left out because an earlier operation had cleared them
  bool reaches_root = true;      ///< false: the ball is too wide and stops in the corners between both walls
};

/// Steps that make more places of one tooth space than are planned in about a minute: the key of the smaller one, and
/// the least of it that does beside the other one, and of both. Nothing: they make fewer.
[[nodiscard]] std::optional<Refusal> steps_too_small(const tooth_space::OffsetSheet& sheet,
                                                     const RoughingOptions& options);

/// `cleared` are the volumes removed by earlier operations: a pass that would cut nothing (`path::kSkinShare`) is left
/// out, and of others what cuts nothing at their ends or over a long stretch between.
[[nodiscard]] Result<RoughingPasses> plan_roughing(const tooth_space::OffsetSheet& sheet,
                                                   const RoughingOptions& options,
                                                   const std::vector<const cut::Removed*>& cleared);

}  // namespace toothpath::ball
