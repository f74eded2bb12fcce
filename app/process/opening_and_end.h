// How commands begin and end: the job and its gear, read and made; files written, the directory made complete.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/process/bevel_run.h"
#include "app/commands/command.h"
#include "app/process/gear_of_job.h"
#include "app/base/output_dir.h"
#include "app/report/run_report.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::process {

template <typename Gear>
struct GearJob {
  job::Job job;
  Gear gear;
};

/// The job in the file and its gear; stages "job" and "gear". Refused: all that is wrong with either, each with its place.
[[nodiscard]] ValueOrErrors<GearJob<face_gear::FaceGear>> read_face_gear_job(const std::string& job_file, app::StageClock& clock);
[[nodiscard]] ValueOrErrors<GearJob<bevel_gear::BevelGear>> read_bevel_gear_job(const std::string& job_file, app::StageClock& clock);

/// Gear and machine of a milling job; stages "gear" and "machine". Both are tried: all that is wrong with either, each with its place. A
/// job without operations is refused.
/// @param make  the gear of a job;  @param load  the machine, called when `gear` is there or refused
template <typename Gear, typename Make, typename Load>
[[nodiscard]] std::vector<Diagnostic> make_gear_and_machine(const job::Job& job, app::StageClock& clock, Make make, Load load, std::optional<Gear>& gear, machines::Machine& machine) {
  if (job.operations.empty()) return {fail_at(job.where("operation"), "the job lacks an [[operation]]: there is nothing to run")};
  std::vector<Diagnostic> errors;
  auto made = clock.run("gear", [&] { return make(job); });
  if (auto* refused = made.refused()) errors = std::move(*refused);
  else gear = std::move(made).value();
  auto loaded = clock.run("machine", load);
  if (auto* refused = loaded.refused()) errors.insert(errors.end(), refused->begin(), refused->end());
  else machine = std::move(loaded).value();
  return errors;
}

/// Contents by file name.
using NamedFiles = std::vector<std::pair<std::string, std::string>>;

/// Writes the files and makes everything that was written visible under its final name. The outcome as it was given, or what could not be
/// written.
[[nodiscard]] commands::CommandOutcome finished(app::OutputDir& output, const NamedFiles& files, commands::CommandOutcome outcome);

/// The report of `surface`, begun: names and warnings of job and gear.
[[nodiscard]] report::RunReport surface_report(const job::Job& job, const std::vector<std::string>& gear_warnings);
/// Closes a report whose other files are written: stages, report.json, summary table.
[[nodiscard]] commands::CommandOutcome finished_report(app::OutputDir& output, app::StageClock& clock, report::RunReport report, bool color);

}  // namespace toothpath::process
