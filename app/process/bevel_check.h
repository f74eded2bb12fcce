// `toothpath check JOB PROGRAM --out DIR` for jobs with a bevel gear.
#pragma once

#include "app/commands/check.h"
#include "app/job/job.h"
#include "app/base/output_dir.h"

namespace toothpath::process {

/// Reads the program back and checks it: gouges, clearance against blank, hub and shaft, rapids, material left, ridges.
/// Writes report.json, report.html and tooth.vtp; the program itself is never touched. `output` is open.
[[nodiscard]] commands::CommandOutcome check_bevel_program(const commands::CheckRequest& request, const job::Job& job, app::OutputDir& output);

}  // namespace toothpath::process
