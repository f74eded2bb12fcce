#include "app/commands/opening_and_end.h"

#include "app/job_file.h"

namespace toothpath {
namespace {

template <typename Gear, typename Make>
ValueOrErrors<GearJob<Gear>> read_gear_job(const std::string& job_file, StageClock& clock, Make make) {
  auto read = clock.run("job", [&] { return read_job_file(job_file); });
  if (auto* errors = std::get_if<1>(&read)) return std::move(*errors);
  Job& job = std::get<0>(read);
  auto made = clock.run("gear", [&] { return make(job); });
  if (auto* errors = std::get_if<1>(&made)) return std::move(*errors);
  return GearJob<Gear>{std::move(job), std::move(std::get<0>(made))};
}

}  // namespace

ValueOrErrors<GearJob<FaceGear>> read_face_gear_job(const std::string& job_file, StageClock& clock) {
  return read_gear_job<FaceGear>(job_file, clock, make_face_gear);
}

ValueOrErrors<GearJob<BevelGear>> read_bevel_gear_job(const std::string& job_file, StageClock& clock) {
  return read_gear_job<BevelGear>(job_file, clock, make_bevel_gear);
}

CommandOutcome finished(OutputDir& output, const NamedFiles& files, CommandOutcome outcome) {
  for (const auto& [name, content] : files)
    if (const auto written = output.write(name, content); !written) return failed(written.error());
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  return outcome;
}

RunReport surface_report(const Job& job, const std::vector<std::string>& gear_warnings) {
  RunReport report;
  report.command = "surface";
  report.job_name = job.name;
  report.job_file = job.file;
  report.warnings = job.warnings;
  report.warnings.insert(report.warnings.end(), gear_warnings.begin(), gear_warnings.end());
  return report;
}

CommandOutcome finished_report(OutputDir& output, StageClock& clock, RunReport report, bool color) {
  report.files.push_back("report.json");
  report.stages = clock.seconds();
  CommandOutcome outcome;
  outcome.report_json = report_json(report);
  outcome.summary = summary_table(report, color);
  const std::string json = outcome.report_json;
  return finished(output, {{"report.json", json}}, std::move(outcome));
}

}  // namespace toothpath
