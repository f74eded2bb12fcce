// Strips and rotaries of a line-milled operation: every flank in the least number of strips that leave little enough,
// each flank by itself, and with the fewest rotaries that do for all of them.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "cam/line/passes.h"
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
  std::optional<int> strips;      ///< 1 .. 24, of every flank; none: for each the least number that meets `left`, more
                                  ///< for an upright tool
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

/// A number of strips that was tried on a flank, and the least that it left; `given_up`: no pass was finished, it
/// leaves more.
struct Way {
  int strips = 1;
  double misfit_mm = 0;
  bool given_up = false;
};

/// The passes of one flank, and how their number was found.
struct FlankPasses {
  std::vector<LinePass> passes;  ///< strips from the tip down
  std::vector<Way> ways;         ///< with rising strips, the planned one last
  [[nodiscard]] double misfit_mm() const;
};

/// The passes of every flank, in their order. Of the numbers of strips the least that does is sought for each flank by
/// itself; of the rotaries the first that do for all flanks are taken, or those of each flank where none do for all.
/// Refused: what `plan_pass` refuses; a `left` that no admitted choice meets, with the flank and the best one.
[[nodiscard]] Result<std::vector<FlankPasses>> plan_flanks(const std::vector<FlankTask>& flanks,
                                                           const tool::Profile& tool, const LineOperation& o);

}  // namespace toothpath::line
