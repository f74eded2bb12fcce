// How commands begin and end: the job and its gear, read and made; files written, the directory made complete.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/commands/bevel_run.h"
#include "app/commands/command.h"
#include "app/gear_of_job.h"
#include "app/output_dir.h"
#include "app/report/run_report.h"
#include "geometry/bevel_gear.h"
#include "geometry/face_gear.h"

namespace toothpath {

template <typename Gear>
struct GearJob {
  Job job;
  Gear gear;
};

/// The job in the file and its gear; stages "job" and "gear". Refused: all that is wrong with either, each with its place.
[[nodiscard]] ValueOrErrors<GearJob<FaceGear>> read_face_gear_job(const std::string& job_file, StageClock& clock);
[[nodiscard]] ValueOrErrors<GearJob<BevelGear>> read_bevel_gear_job(const std::string& job_file, StageClock& clock);

/// Contents by file name.
using NamedFiles = std::vector<std::pair<std::string, std::string>>;

/// Writes the files and makes everything that was written visible under its final name. The outcome as it was given, or what could not be
/// written.
[[nodiscard]] CommandOutcome finished(OutputDir& output, const NamedFiles& files, CommandOutcome outcome);

/// The report of `surface`, begun: names and warnings of job and gear.
[[nodiscard]] RunReport surface_report(const Job& job, const std::vector<std::string>& gear_warnings);
/// Closes a report whose other files are written: stages, report.json, summary table.
[[nodiscard]] CommandOutcome finished_report(OutputDir& output, StageClock& clock, RunReport report, bool color);

}  // namespace toothpath
