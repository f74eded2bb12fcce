// How commands begin and end: the job and its gear, read and made; files written, the directory made complete.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/base/outcome.h"
#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "app/process/gear_of_job.h"
#include "app/report/run_report.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::process {

template <typename Gear>
struct GearJob {
  job::Job job;
  Gear gear;
};

/// The job in the file and its gear; stages "job" and "gear". Refused: all that is wrong with either, each with its
/// place.
[[nodiscard]] ValueOrErrors<GearJob<face_gear::FaceGear>> read_face_gear_job(const std::string& job_file,
                                                                             app::StageClock& clock);
[[nodiscard]] ValueOrErrors<GearJob<bevel_gear::BevelGear>> read_bevel_gear_job(const std::string& job_file,
                                                                                app::StageClock& clock);

/// Contents by file name.
using NamedFiles = std::vector<std::pair<std::string, std::string>>;

/// Writes the files and makes everything that was written visible under its final name. The outcome as it was given, or
/// what could not be written.
[[nodiscard]] app::CommandOutcome finished(app::OutputDir& output, const NamedFiles& files,
                                           app::CommandOutcome outcome);

/// The report of `surface`, begun: names and warnings of job and gear.
[[nodiscard]] report::RunReport surface_report(const job::Job& job, const std::vector<std::string>& gear_warnings);
/// Closes a report whose other files are written: stages, report.json, summary table.
[[nodiscard]] app::CommandOutcome finished_report(app::OutputDir& output, app::StageClock& clock,
                                                  report::RunReport report, bool color);

}  // namespace toothpath::process
