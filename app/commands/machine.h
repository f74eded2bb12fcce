// `toothpath machine show` and `toothpath machine test`: what a machine file says, and a program that proves it in air.
#pragma once

#include "app/commands/command.h"

namespace toothpath {

/// Prints the machine of `request.job_file` (a path, or the name of an installed machine): limits, chain, what a positive command
/// turns, every assumed value. With an output directory also machine.html and machine.svg (milling machines).
[[nodiscard]] CommandOutcome show_machine(const CommandRequest& request);

}  // namespace toothpath
