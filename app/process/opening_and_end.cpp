#include "app/process/opening_and_end.h"

#include "app/job/file.h"

namespace toothpath::process {
namespace {

template <typename Gear, typename Make>
ValueOrErrors<GearJob<Gear>> read_gear_job(const std::string& job_file, app::StageClock& clock, Make make) {
  auto read = clock.run("job", [&] { return job::read_job_file(job_file); });
  if (auto* errors = read.refused()) return std::move(*errors);
  job::Job& job = read.value();
  auto made = clock.run("gear", [&] { return make(job); });
  if (auto* errors = made.refused()) return std::move(*errors);
  return GearJob<Gear>{std::move(job), std::move(made).value()};
}

}  // namespace

ValueOrErrors<GearJob<face_gear::FaceGear>> read_face_gear_job(const std::string& job_file, app::StageClock& clock) {
  return read_gear_job<face_gear::FaceGear>(job_file, clock, make_face_gear);
}

ValueOrErrors<GearJob<bevel_gear::BevelGear>> read_bevel_gear_job(const std::string& job_file, app::StageClock& clock) {
  return read_gear_job<bevel_gear::BevelGear>(job_file, clock, make_bevel_gear);
}

app::CommandOutcome finished(app::OutputDir& output, const NamedFiles& files, app::CommandOutcome outcome) {
  for (const auto& [name, content] : files)
    if (const auto written = output.write(name, content); !written) return app::failed(written.error());
  if (const auto committed = output.commit(); !committed) return app::failed(committed.error());
  return outcome;
}

report::RunReport surface_report(const job::Job& job, const std::vector<std::string>& gear_warnings) {
  report::RunReport report;
  report.command = "surface";
  report.job_name = job.name;
  report.job_file = job.file;
  report.warnings = job.warnings;
  report.warnings.insert(report.warnings.end(), gear_warnings.begin(), gear_warnings.end());
  return report;
}

app::CommandOutcome finished_report(app::OutputDir& output, app::StageClock& clock, report::RunReport report,
                                    bool color) {
  report.files.push_back("report.json");
  report.stages = clock.seconds();
  app::CommandOutcome outcome;
  outcome.report_json = report::report_json(report);
  report.directory = output.path();
  outcome.summary = report::summary_table(report, color);
  const std::string json = outcome.report_json;
  return finished(output, {{"report.json", json}}, std::move(outcome));
}

}  // namespace toothpath::process
