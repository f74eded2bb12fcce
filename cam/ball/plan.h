// Plans the operations of a ball end for one tooth space: from flanks to CL paths.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/ball/tool_orientation.h"
#include "cam/cut/swept_tool.h"
#include "cam/path/cl_path.h"
#include "cam/path/operation.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"
#include "geometry/base/refusal.h"
#include "geometry/base/result.h"

namespace toothpath::ball {

/// Roughing works on tables of the offset walls: this covers the sag between their entries, so that much more than its
/// allowance may stay. mm
inline constexpr double kRoughingPad = 0.004;

struct PlanOptions {
  proof::ProofLimits
      limits;  ///< of shank and holder the clearance; chords of any operation may use a part of the gouge tolerance
  double rapid_clearance_mm = 2.0;  ///< height of rapids above the blank
  double clearance_room_mm = 0;     ///< that fixed directions keep beyond the clearance, for words, control and proof
  double link_feed_mm_min = 0;      ///< of moves under feed where nothing can be cut: drawing back, coming down to
                                    ///< where stock may begin; 0, or below that of the operation: as the operation
  double least_tilt_rad =
      0.035;  ///< of a tool axis that turns in a pass, from the gear axis: the pole of a rotary that carries the work
  /// The post goes past that pole ("slow", "hold", "through", "retract"): where no motion keeps away from it, one that
  /// does not is planned.
  bool pole_is_passed = false;
  bool trial = false;  ///< asked only whether there is a plan: refusals look for nothing that would do
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
  double step_over_mm = 0;  ///< roughing: that of its layers
  /// Roughing: the passes that open a layer, slots, by zone and pass of the records.
  std::vector<std::pair<int, int>> openings;
};

/// A refusal with the key of the job it belongs to ("operation[2].tool", ...).
struct PlanRefusal : Refusal {
  std::vector<ToolTrial> trials = {};  ///< tools with which the operation was planned; their words stand in the message
};

/// One operation of a ball, or of another end that a ball contains.
struct Planned {
  path::ClPath path;
  OperationPlan summary;
  std::vector<proof::DirectionChoice> directions;
};

/// Plans roughing, semi-finishing and finishing, operation by operation. What it is made of must outlive it.
/// Axes that lead the tool beside poses that are cut before: those of passes on flank +1 and of others.
struct LedAxes {
  std::vector<path::ToolAxisKey> plus, minus;
};
/// For every zone what is tried in turn, and in words what leads.
struct Leading {
  std::vector<std::vector<LedAxes>> zones;
  std::string words;  ///< "beside the poses of operation 6"
};

class Planner {
 public:
  Planner(const analytic::GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
          const std::vector<path::MillingOperation>& operations, const PlanOptions& options);
  ~Planner();
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;

  /// @param cleared  what earlier operations removed: roughing passes that would cut nothing are left out
  /// @param leading  axes that are taken where tool and part keep clear, before a direction of its own is looked for
  [[nodiscard]] Expected<Planned, PlanRefusal> plan(int operation, const std::vector<const cut::Removed*>& cleared,
                                                    const std::optional<Leading>& leading = {});

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// The most that stands on the finished surface, and on the operation's own allowance, where it cuts. mm. Infinite
/// where nothing was cut before, or by a tool that is larger or not round and so stayed above; and while roughing.
[[nodiscard]] double stock_before(const std::vector<path::MillingOperation>& operations,
                                  const std::vector<tool::ToolAssembly>& tools, std::size_t n);

/// Way along the axis before an operation's passes on which its tool may meet stock: coming down from above it, along
/// walls that are steep; a side that widens upwards meets it higher. mm. Infinite where `stock_before` is, but for
/// roughing, which comes down to the next layer.
[[nodiscard]] double slow_way(const std::vector<path::MillingOperation>& operations,
                              const std::vector<tool::ToolAssembly>& tools, std::size_t n);

/// Largest distance that the planner and the checks will ask `GearDistance` for with these tools.
[[nodiscard]] double reach_of(const std::vector<tool::ToolAssembly>& tools);

}  // namespace toothpath::ball
