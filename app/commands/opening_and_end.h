// How commands begin and end: the job and its gear, read and made; files written, the directory made complete.
#pragma once

#include <optional>
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

/// Gear and machine of a milling job; stages "gear" and "machine". Both are tried: all that is wrong with either, each with its place. A
/// job without operations is refused.
/// @param make  the gear of a job;  @param load  the machine, called when `gear` is there or refused
template <typename Gear, typename Make, typename Load>
[[nodiscard]] std::vector<Diagnostic> make_gear_and_machine(const Job& job, StageClock& clock, Make make, Load load, std::optional<Gear>& gear, Machine& machine) {
  if (job.operations.empty()) return {fail_at(job.where("operation"), "the job lacks an [[operation]]: there is nothing to run")};
  std::vector<Diagnostic> errors;
  auto made = clock.run("gear", [&] { return make(job); });
  if (auto* refused = std::get_if<1>(&made)) errors = std::move(*refused);
  else gear = std::move(std::get<0>(made));
  auto loaded = clock.run("machine", load);
  if (auto* refused = std::get_if<1>(&loaded)) errors.insert(errors.end(), refused->begin(), refused->end());
  else machine = std::move(std::get<0>(loaded));
  return errors;
}

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
