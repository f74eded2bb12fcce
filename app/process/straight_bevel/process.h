// Straight bevel gears, milled with ball mills: what the commands want of them.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::straight_bevel {

/// The straight bevel gear of the job, which must outlive it. Refused: what process::make_straight_bevel_gear refuses.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::straight_bevel
