// What an axis program can be built from: inputs that nobody else has checked together.
#pragma once

#include <optional>
#include <span>

#include "cam/cl_path.h"
#include "postproc/axis_program.h"

namespace toothpath {

/// Empty: paths, tools, machine and options fit together. Else what does not, with the operation and record.
[[nodiscard]] std::optional<Diagnostic> check_axis_inputs(std::span<const ClPath* const> paths, std::span<const ToolAssembly> tools,
                                                          const Machine& machine, int teeth, const AxisOptions& options);

}  // namespace toothpath
