// `toothpath run`: from the job to a proven NC program and everything that goes with it.
#pragma once

#include <functional>

#include "app/commands/command.h"
#include "app/process/cad/cad_files.h"
#include "app/process/flow/stages.h"

namespace toothpath::commands {

/// Of `run` and `correct`.
struct RunRequest : JobRequest, flow::RunAsked {
  cad::FilesAsked cad;
  std::function<void(flow::Run&)> finished = {};  ///< called last, once the files are there; may take what it wants
};

/// Gear, plan, gouge check, axis program, NC text, read back from the disk, proof, report. A program that is not proven
/// is not left in the directory; the report is, and says why.
[[nodiscard]] CommandOutcome run_job(const RunRequest& request);

}  // namespace toothpath::commands
