// The commands for equal-base-circle bevel gears: `surface` and `run` with a finger mill. The same files and reports as for
// face gears; no ball-mill code runs.
#pragma once

#include "app/commands/command.h"
#include "app/process/gear_of_job.h"
#include "app/job/job.h"
#include "app/base/output_dir.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::commands {
struct RunRequest;
}  // namespace toothpath::commands
namespace toothpath::process {


/// The job of this file if it is readable and asks for a bevel gear; else nothing (whoever reads it next reports why).
[[nodiscard]] std::optional<job::Job> bevel_job(const std::string& job_file);

/// The bevel gear of the job, as its finishing mill makes it (the tool of the last finger_finishing; without one the first
/// finger mill). Refused: everything that BevelGear::make refuses, each with its place.
[[nodiscard]] ValueOrErrors<bevel_gear::BevelGear> make_bevel_gear(const job::Job& job);

/// Flanks, limits, inspection points and meshes. `output` is open.
[[nodiscard]] commands::CommandOutcome run_bevel_surface(const commands::JobRequest& request, const job::Job& job, app::OutputDir& output);

/// Plan, check, post, read back, prove, report. A program that is not proven is not left in the directory.
[[nodiscard]] commands::CommandOutcome run_bevel_job(const commands::RunRequest& request, const job::Job& job, app::OutputDir& output);

}  // namespace toothpath::process
