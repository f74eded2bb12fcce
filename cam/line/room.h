// The room of a mill at a flank: is the whole tool clear of the finished gear where it stands?
#pragma once

#include "cam/analytic/gear_distance.h"
#include "cam/line/passes.h"
#include "cam/tool/profile.h"

namespace toothpath::line {

struct RoomOptions {
  double clearance_mm = 0.05;  ///< least gap of shank and holder
  double touch_mm =
      1e-4;  ///< how deep the cutting part may be bounded: its own flank it touches, up to the bias of the pass
  double stock_mm = 0;  ///< that it leaves on every flank, its own and the opposite one
};

/// Answers for any pose of the tool in the gear frame, on flanks of any tooth: neither does the cutting part cut, nor
/// do shank and holder come nearer than the clearance, all proven as for motions (cam/analytic/profile_sweep.h,
/// cam/analytic/body_sweep.h). Asked from several threads at once. `part` must outlive it.
[[nodiscard]] Room room_of(const analytic::GearDistance& part, const tool::Profile& tool,
                           const RoomOptions& options = {});

}  // namespace toothpath::line
