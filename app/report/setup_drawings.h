// Sketches of the set-up sheet, inline SVG.
#pragma once

#include <string>

#include "app/report/setup_sheet.h"
#include "cam/cutter.h"
#include "machines/machine.h"
#include "postproc/setup.h"

namespace toothpath {

/// Part in the X-Z plane of the machine, with its origin, the work offset and the rotary axes that the table carries.
[[nodiscard]] std::string part_sketch(const Setup& setup, const PartOutline& part, const Machine& machine);

/// Cutter, shank and holder from the side, tip at the bottom.
[[nodiscard]] std::string tool_sketch(const ToolAssembly& tool);

}  // namespace toothpath
