// What a printed time holds, and what it assumes: said wherever times are printed.
#pragma once

#include <string>

#include "machines/machine.h"

namespace toothpath::timing {

/// One sentence without full stop.
[[nodiscard]] std::string model_text(const machines::Machine& machine);

}  // namespace toothpath::timing
