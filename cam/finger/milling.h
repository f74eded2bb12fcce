// Paths of a finger mill through one tooth space of an equal-base-circle bevel gear.
//
// The cutter axis stays normal to the pitch cone and the tip on the root cone, so a path is a curve (R_c, e) of the
// crown plane: R_c along the generatrix, e the azimuth. Roughing: the middle of the space and the fill passes that keep
// the ridges on the root low. Finishing: both walls of every half, which end so that no other wall is touched. Engage
// and retract run along the cutter axis. Where they go: cam/finger/passes.h; here they become blocks with feeds.
// Derivation: docs/bevel_gear.md, section 6.
#pragma once

#include <string>
#include <vector>

#include "cam/finger/passes.h"
#include "cam/path/cl_path.h"
#include "cam/path/operation.h"
#include "cam/proof/limits.h"
#include "cam/tool/assembly.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

/// One pass in one half, for reports. The convex side of a herringbone runs through both halves: two entries.
struct FingerPass {
  int half = 0;          ///< 0 inner, 1 outer
  int pass = 0;          ///< number in the half
  std::string name;      ///< "middle", "fill 0.33", "wall L", "wall U"
  bool outward = false;  ///< R_c grows
  double length_mm = 0;  ///< of the centre path on the pitch cone
  std::size_t points = 0;
};

struct FingerPlan {
  path::ClPath path;
  std::vector<FingerPass> passes;
  double chord_mm = 0;            ///< no block leaves the exact path by more, straight tip or straight joints
  double ridge_predicted_mm = 0;  ///< roughing: highest ridge between passes and walls
};

/// How the mill of one tool goes into a gear: refuses a tool that does not fit it.
/// @param gear  made with the finishing mill; a tool with other numbers gets its own equidistants
[[nodiscard]] Result<bevel_gear::BevelGear> gear_for_finger_mill(const bevel_gear::BevelGear& gear,
                                                                 const tool::ToolAssembly& tool);
[[nodiscard]] bevel_gear::FingerCutterData finger_cutter_data(const tool::ToolAssembly& tool);

/// finger_roughing or finger_finishing of tooth space 0. The chord of a block stays within the operation's chord
/// tolerance and within half of the gouge tolerance divided by the leverage of the proof (centre_leverage). Feeds:
/// op.feed_mm_min is the speed of the cutter centre on the pitch cone; a record carries the tip speed that belongs to
/// it.
[[nodiscard]] Result<FingerPlan> plan_finger_operation(const bevel_gear::BevelGear& gear,
                                                       const tool::ToolAssembly& tool,
                                                       const path::MillingOperation& operation, int operation_index,
                                                       const proof::ProofLimits& limits);

}  // namespace toothpath::finger
