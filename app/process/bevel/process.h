// Equal-base-circle bevel gears, milled with finger mills: everything that the commands want of them.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::bevel {

/// The bevel gear of the job, which must outlive it. Refused: what process::make_bevel_gear refuses.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::bevel
