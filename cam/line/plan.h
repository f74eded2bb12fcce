// Line milling of one tooth space: every flank of every ring in its own number of strips (cam/line/choice.h), and their
// way.
//
// Asks a toothed part, a tool profile and an operation; answers a path (CL records of space 0) and what a report draws
// of each pass.
#pragma once

#include <algorithm>
#include <vector>

#include "cam/line/choice.h"
#include "cam/path/cl_path.h"
#include "cam/tool/profile.h"

namespace toothpath::line {

/// What one flank takes for the same `left`, by the side of a mill and by its ball end. Minutes of one tooth space at
/// the feed of the contact: what links, rapids and the axes of a machine add is not in them.
struct FlankWays {
  int zone = 0, side = 1;
  std::vector<Way> strips;  ///< with rising strips, the planned one last; empty: the side does not cut it
  double minutes = 0;       ///< of the strips that are planned
  int ball_passes = 0;      ///< about
  double ball_minutes = 0;
};
/// Of every flank by the ball end alone. Refused: what `flank_task` refuses.
[[nodiscard]] Result<std::vector<FlankWays>> ways_by_ball(const tooth_space::ToothedPart& part, double ball_radius_mm,
                                                          double left_mm, double feed_mm_min);

struct LinePlan {
  path::ClPath path;
  std::vector<LinePass> passes;  ///< zones with rising s, flank +1 then -1, strips from the tip down; the path may
                                 ///< order flanks otherwise
  int strips = 1;                ///< the most that a flank has
  Rotaries rotaries = Rotaries::both;  ///< of all passes; both where they differ
  double misfit_mm = 0;                ///< worst of the passes
  std::vector<FlankWays> ways;         ///< of the flanks in the order of their passes; empty without a `left`
  [[nodiscard]] double left_mm() const {
    double most = 0;
    for (const LinePass& pass : passes) most = std::max(most, pass.left_mm);
    return most;
  }
  double least_feed_mm_min = 0;  ///< of the contact, in the slowest block
};

/// Feed of the contact in a block: the job's, or what the limits leave of it. mm/min
/// @param contact_mm  way of the contact
[[nodiscard]] double contact_feed(double feed_mm_min, const FeedLimits& limits, double contact_mm, const Vec3& tip_from,
                                  const Vec3& axis_from, const Vec3& tip_to, const Vec3& axis_to);

/// Plans one operation. Refused, with quantity, value and limit: a tool without a ball end and a side; everything that
/// `flank_task` and `plan_pass` refuse; a `left` that no admitted choice meets (the message tells the best one).
[[nodiscard]] Result<LinePlan> plan_line_milling(const tooth_space::ToothedPart& part, const tool::Profile& tool,
                                                 const LineOperation& operation);

}  // namespace toothpath::line
