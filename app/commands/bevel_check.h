// `toothpath check JOB PROGRAM --out DIR` for jobs with a bevel gear.
#pragma once

#include "app/commands/check.h"
#include "app/job.h"
#include "app/output_dir.h"

namespace toothpath {

/// Reads the program back and checks it: gouges, clearance against blank, hub and shaft, rapids, material left, ridges.
/// Writes report.json, report.html and tooth.vtp; the program itself is never touched. `output` is open.
[[nodiscard]] CommandOutcome check_bevel_program(const CheckRequest& request, const Job& job, OutputDir& output);

}  // namespace toothpath
