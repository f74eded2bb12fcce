// Sketches of the set-up sheet, inline SVG.
#pragma once

#include <string>

#include "app/report/sheet/setup_sheet.h"
#include "cam/tool/assembly.h"
#include "machines/machine.h"
#include "postproc/joints/setup.h"

namespace toothpath::sheet {

/// Part in the X-Z plane of the machine with its diameters, the zero point, the gear origin, the rotary axes that the
/// table carries, and every height that is looked for, in machine and work coordinates.
[[nodiscard]] std::string part_sketch(const joints::Setup& setup, const PartOutline& part,
                                      const machines::Machine& machine);

/// Cutter, shank and holder from the side, tip at the bottom, with its number, diameter, flutes, stick-out and the
/// length from the gauge line to the tip, mm.
[[nodiscard]] std::string tool_sketch(const tool::ToolAssembly& tool);

}  // namespace toothpath::sheet
