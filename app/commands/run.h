// `toothpath run`: from the job to a proven NC program and everything that goes with it.
#pragma once

#include "app/commands/command.h"

namespace toothpath {

/// Gear, plan, gouge check, axis program, NC text, read back from the disk, proof, report. A program that is not proven is not
/// left in the directory; the report is, and says why.
[[nodiscard]] CommandOutcome run_job(const CommandRequest& request);

}  // namespace toothpath
