// `toothpath shaper`: limits, set-up sheet and stroke program of a gear shaper. Plans no path and builds no mesh.
#pragma once

#include <string>
#include <vector>

#include "app/commands/command.h"

namespace toothpath::commands {

/// Files that the command owns in its output directory.
[[nodiscard]] const std::vector<std::string>& shaper_outputs();

/// Writes limits.json, shaper.json, shaper.html, shaper_program.ngc and report.json. Refused, with the place in the
/// job: what the gear, the set-up or the machine does not allow; assumed values of the machine that the job does not
/// accept. Then no file is written.
[[nodiscard]] CommandOutcome run_shaper(const JobRequest& request);

}  // namespace toothpath::commands
