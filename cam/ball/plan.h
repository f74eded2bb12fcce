// Plans every operation of a face gear job for one tooth space: from flanks to CL paths.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/path/cl_path.h"
#include "cam/path/operation.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"
#include "geometry/base/result.h"

namespace toothpath::ball {

struct PlanOptions {
  proof::ProofLimits
      limits;  ///< of shank and holder the clearance; chords of any operation may use a part of the gouge tolerance
  double rapid_clearance_mm = 2.0;  ///< height of rapids above the blank
  double least_tilt_rad =
      0.035;  ///< of a tool axis that turns in a pass, from the gear axis: the pole of a rotary that carries the work
  /// The post goes past that pole ("slow", "hold", "through", "retract"): where no motion keeps away from it, one that
  /// does not is planned.
  bool pole_is_passed = false;
  /// Runs a stage under its name; empty: just runs it. Called on the thread of the caller, for "tool passes", "tool
  /// direction" and "links", and for "five-axis orientation" only where it is needed.
  std::function<void(const std::string& name, const std::function<void()>& work)> stage;
};

/// What the planner knows about one operation; for the ledger and the report.
struct OperationPlan {
  int operation = 0;
  double scallop_max_mm = 0;  ///< highest cusp between two passes, predicted; 0 for roughing
  double crest_lean = 0;      ///< what of a path error sideways shows in the height of a cusp, at most
  double chord_mm = 0;        ///< largest sag of a block against the exact path
  int passes = 0, skipped_passes = 0, layers = 0;
  bool corner_passes = false;
};

struct FaceGearPlan {
  std::vector<path::ClPath> paths;  ///< one an operation
  std::vector<OperationPlan> operations;
  std::vector<proof::DirectionChoice> directions;
};

/// A refusal with the key of the job it belongs to ("operation[2].tool", ...).
struct PlanRefusal {
  std::string key;
  Diagnostic diagnostic;
};

using PlanProgress = std::function<void(const std::string&)>;

[[nodiscard]] Expected<FaceGearPlan, PlanRefusal> plan_face_gear(const analytic::GearDistance& part,
                                                                 const std::vector<tool::ToolAssembly>& tools,
                                                                 const std::vector<path::MillingOperation>& operations,
                                                                 const PlanOptions& options,
                                                                 const PlanProgress& progress = {});

/// Largest distance that the planner and the checks will ask `GearDistance` for with these tools.
[[nodiscard]] double reach_of(const std::vector<tool::ToolAssembly>& tools);

}  // namespace toothpath::ball
