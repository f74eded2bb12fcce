// What an axis program is built from: inputs that nobody else has checked together, and the rules that follow from them.
#pragma once

#include <optional>
#include <span>

#include "cam/cl_path.h"
#include "postproc/axis_pole.h"
#include "postproc/axis_program.h"

namespace toothpath {

/// Empty: paths, tools, machine and options fit together. Else what does not, with the operation and record.
[[nodiscard]] std::optional<Diagnostic> check_axis_inputs(std::span<const ClPath* const> paths, std::span<const ToolAssembly> tools,
                                                          const Machine& machine, int teeth, const AxisOptions& options);

/// What the poles of a path with this tool are handled by: the option of the machine file and its bounds.
[[nodiscard]] PoleRules pole_rules_of(const Machine& machine, const AxisOptions& options, const ToolAssembly& tool, const ClearanceBody& body);

}  // namespace toothpath
