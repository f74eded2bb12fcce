// The commands for equal-base-circle bevel gears: `surface` and `run` with a finger mill. The same files and reports as for
// face gears; no ball-mill code runs.
#pragma once

#include "app/commands/command.h"
#include "app/gear_of_job.h"
#include "app/job.h"
#include "app/output_dir.h"
#include "geometry/bevel_gear.h"

namespace toothpath {

struct RunRequest;

/// The job of this file if it is readable and asks for a bevel gear; else nothing (whoever reads it next reports why).
[[nodiscard]] std::optional<Job> bevel_job(const std::string& job_file);

/// The bevel gear of the job, as its finishing mill makes it (the tool of the last finger_finishing; without one the first
/// finger mill). Refused: everything that BevelGear::make refuses, each with its place.
[[nodiscard]] ValueOrErrors<BevelGear> make_bevel_gear(const Job& job);

/// Flanks, limits, inspection points and meshes. `output` is open.
[[nodiscard]] CommandOutcome run_bevel_surface(const JobRequest& request, const Job& job, OutputDir& output);

/// Plan, check, post, read back, prove, report. A program that is not proven is not left in the directory.
[[nodiscard]] CommandOutcome run_bevel_job(const RunRequest& request, const Job& job, OutputDir& output);

}  // namespace toothpath
