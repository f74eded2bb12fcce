// Gears by points, milled with ball mills: what the commands want of them.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::flank_grid {

/// The gear by points of the job, which must outlive it. Refused: what process::make_flank_grid_gear refuses.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::flank_grid
