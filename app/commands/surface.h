// `toothpath surface`: flanks, limits, mesh and inspection grid of the gear. Plans no path and loads no ray tracer.
#pragma once

#include "app/commands/command.h"
#include "app/job/job.h"

namespace toothpath::commands {

/// Files that the command owns in its output directory.
[[nodiscard]] const std::vector<std::string>& surface_outputs();

[[nodiscard]] CommandOutcome run_surface(const JobRequest& request);

}  // namespace toothpath::commands
