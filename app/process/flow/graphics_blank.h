// The blank of a job as the graphics of a control show it.
#pragma once

#include <optional>

#include "app/process/gear_process.h"
#include "postproc/joints/setup.h"

namespace toothpath::flow {

/// The smallest ring that holds the blank. Nothing: the gear axis is not Z of the work offset.
[[nodiscard]] std::optional<joints::GraphicsBlank> graphics_blank(const process::GearProcess& gear,
                                                                  const joints::Setup& setup);

}  // namespace toothpath::flow
