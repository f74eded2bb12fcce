// Spiral bevel gears, milled with ball mills: what the commands want of them.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::spiral_bevel {

/// The spiral bevel gear of the job, which must outlive it. Refused: what process::make_spiral_bevel_gear refuses.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::spiral_bevel
