// Line milling of one tooth space: every flank of every ring in the fewest strips and with the fewest rotaries that
// leave little enough.
//
// Asks a toothed part, a tool profile and an operation; answers a path (CL records of space 0) and what a report draws
// of each pass.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "cam/line/passes.h"
#include "cam/path/cl_path.h"
#include "cam/path/operation.h"
#include "cam/tool/profile.h"

namespace toothpath::line {

using path::kMostStrips;
/// Gap that the poses keep by default, mm: what the proof may stand above what it finds (2e-4) and the rounding of axes
/// to 1e-4 mm and deg.
inline constexpr double kBias = 3e-4;

/// What else than the job limits the feed of the contact, as far as it is known before the machine is. A posture that
/// runs through the axes of a machine is slowed once more where its own axes ask for it.
struct FeedLimits {
  double tip_mm_min = INFINITY;       ///< way of the tip in the gear frame
  double tilt_rad_min = INFINITY;     ///< turn of the axis from the gear axis
  double azimuth_rad_min = INFINITY;  ///< turn of the axis about the gear axis
  double block_s = 0;                 ///< least time of a block
};

/// What is asked. Lengths mm.
struct LineOperation {
  int operation = 0;  ///< index in the job
  int tool = 0;       ///< index into the job's list of tools
  double speed_rpm = 0;
  double feed_mm_min = 0;         ///< of the contact
  double allowance_mm = 0;        ///< stock that is left on the flank; 0: finishing
  std::optional<int> strips;      ///< 1 .. 24; none: the least number that meets `left`, more for an upright tool
  std::optional<double> left_mm;  ///< largest misfit of a pass; none: whatever one strip with both rotaries leaves
  /// Admitted, tried in this order for each number of strips; empty: the tilt stands where that meets `left`, else
  /// both.
  std::vector<Rotaries> rotaries;
  bool both_admitted = true;  ///< does the control move both rotaries at once? Else a refusal does not offer it
  double chord_tolerance_mm = 5e-4;
  double bias_mm = kBias;       ///< see PassOptions; coarser axes ask for more: 8e-4 for 0.001 mm and deg
  double base_lift_mm = 0;      ///< see PassOptions; of the lowest strip
  double link_feed_mm_min = 0;  ///< of moves that cannot cut; 0, or below `feed_mm_min`: as that
  double slow_mm = INFINITY;    ///< way along the axis before a pass on which stock may be met
  FeedLimits limits;
  bool climb = true;               ///< spindle M3, material to the right of the feed seen from the holder
  double clearance_height_mm = 0;  ///< h of the chart above which every part of the tool is for rapids
  Room room;                       ///< cam/line/room.h
};

struct LinePlan {
  /// A number of strips that was tried, and the least that it left; `given_up`: no pass was finished, it leaves more.
  struct Way {
    int strips = 1;
    double misfit_mm = 0;
    bool given_up = false;
  };
  path::ClPath path;
  std::vector<LinePass> passes;  ///< zones with rising s, flank +1 then -1, strips from the tip down; the path may
                                 ///< order flanks otherwise
  int strips = 1;
  Rotaries rotaries = Rotaries::both;
  double misfit_mm = 0;   ///< worst of the passes
  std::vector<Way> ways;  ///< with rising strips, the planned one last; where `left` chose them
  int ball_passes = 0;  ///< that the ball end of this tool would take for the same `left`, of all flanks; 0: not asked
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
