// What a printed time holds, and what it assumes: said wherever times are printed.
#pragma once

#include <string>

#include "machines/machine.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::timing {

/// One sentence without full stop.
[[nodiscard]] std::string model_text(const machines::Machine& machine, Corners corners);

}  // namespace toothpath::timing
