// What an axis program is built from: inputs that nobody else has checked together, and the rules that follow from
// them.
#pragma once

#include <optional>
#include <span>

#include "cam/path/cl_path.h"
#include "postproc/joints/pole.h"
#include "postproc/joints/program.h"

namespace toothpath::joints {

/// Empty: paths, tools, machine and options fit together. Else what does not, with the operation and record.
[[nodiscard]] std::optional<Diagnostic> check_axis_inputs(std::span<const path::ClPath* const> paths,
                                                          std::span<const tool::ToolAssembly> tools,
                                                          const machines::Machine& machine, int teeth,
                                                          const AxisOptions& options);

/// What the poles of a path with this tool are handled by: the option of the machine file and its bounds.
[[nodiscard]] PoleRules pole_rules_of(const machines::Machine& machine, const AxisOptions& options,
                                      const tool::ToolAssembly& tool, const ClearanceBody& body);

}  // namespace toothpath::joints
