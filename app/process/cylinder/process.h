// Cylindrical gears, milled with ball mills: everything that the commands want of them.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::cylinder {

/// The cylindrical gear of the job, which must outlive it. Refused: what process::make_cylindrical_gear refuses.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::cylinder
