// Feeds of an operation by the chip that the job allows (`chip_load`): raised where little of the mill is in the
// material, never above that chip. docs/force.md.
#pragma once

#include <vector>

#include "cam/ball/plan.h"
#include "cam/cut/engagement.h"
#include "cam/path/cl_path.h"
#include "cam/path/operation.h"
#include "cam/tool/assembly.h"

namespace toothpath::plan {

/// How a roughing mill stands in the material along its path, at the ends of its feed motions: vectors of one length.
struct EngagementTrack {
  int operation = 0;
  std::vector<double> way_mm;       ///< of the feed motions so far
  std::vector<double> engaged_rad;  ///< of a tooth, greatest in the motion
  std::vector<double> chip_mm;      ///< largest in the motion, with the feed below
  std::vector<double> feed_mm_min;
  double step_over_mm = 0;  ///< of its layers: the job's, or less where `max_engagement` asks for it
  double beside_rad = 0;    ///< greatest but for the passes that open a layer
  double opening_mm = 0;    ///< way of those
};

/// Greatest angle (`Engaged::loaded_rad`) of the feed motions but for those of the passes that open a layer, and the
/// way of these.
struct BesideSlots {
  double engaged_rad = 0, opening_mm = 0;
};
[[nodiscard]] BesideSlots beside_slots(const path::ClPath& path, const std::vector<cut::Engaged>& engaged,
                                       const ball::OperationPlan& plan);

/// Step-over from which on a cylinder as wide as the mill is `step_down` above its tip is in the material over more
/// than this angle beside the pass before: no larger one keeps it. mm
[[nodiscard]] double widest_step_mm(const tool::Meridian& cutting, double step_down_mm, double angle_rad);

/// Follows a roughing path through the stock and sets its feeds. `engaged`: one a motion of the path
/// (`GougeCheck::motions_of`), from `cut::engagement_along`.
[[nodiscard]] EngagementTrack feed_by_engagement(path::ClPath& path, const std::vector<cut::Engaged>& engaged,
                                                 const path::MillingOperation& operation, int teeth);

/// The same for passes that meet even stock: one factor for the whole path, from the operations before.
/// @param contact_top_mm  line milling: highest contact above the tip
void feed_by_stock(path::ClPath& path, const std::vector<path::MillingOperation>& operations,
                   const std::vector<tool::ToolAssembly>& tools, std::size_t n, double contact_top_mm);

}  // namespace toothpath::plan
