// One operation of a job: what the planners need to know, feeds in mm/min, lengths in mm.
#pragma once

#include <vector>

namespace toothpath::path {

/// One key of a tool axis that the job prescribes: with the ball centre at this radius about the gear axis the tool
/// leans so far from the normal of the pitch surface, outwards along the teeth and aside towards growing azimuth (away
/// from flank +1, towards flank -1).
struct ToolAxisKey {
  double radius_mm = 0, outwards_rad = 0, aside_rad = 0;
};

enum class OperationType { roughing, semi_finishing, finishing, finger_roughing, finger_finishing };
[[nodiscard]] const char* to_string(OperationType type);  ///< as in the job file

struct MillingOperation {
  OperationType type = OperationType::finishing;
  int tool = 0;  ///< index into the list of tools
  double speed_rpm = 0;
  double feed_mm_min = 0;   ///< of the contact point (ball mill) or cutter centre on the pitch cone (finger mill)
  double step_down_mm = 0;  ///< roughing: between layers
  double step_over_mm = 0;  ///< roughing: between passes of a layer
  double allowance_mm = 0;  ///< stock left, along the normal of the finished surface
  double scallop_mm = 0;    ///< semi-finishing and finishing: cusp height between passes
  double chord_tolerance_mm = 0.005;  ///< sag of a block against the exact path; not asked for: 0.005
  bool climb = true;
  double chip_load_mm = 0;        ///< largest chip of a tooth; 0: none is asked for
  double max_engagement_rad = 0;  ///< largest angle of a tooth in the material; 0: none is asked for
  double ridge_mm = 0;            ///< finger roughing: highest ridge left on the root
  /// Semi-finishing and finishing: prescribed tool axes, by ascending radius; both empty (the planner chooses) or both
  /// not. Those of passes on flank +1 of tooth 0 and its half of the root, and of the others.
  std::vector<ToolAxisKey> axis_plus, axis_minus;
};

}  // namespace toothpath::path
