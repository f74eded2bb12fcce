// `toothpath surface` for a bevel gear.
#include "app/commands/bevel_files.h"
#include "app/commands/bevel_run.h"
#include "app/report/run_report.h"

namespace toothpath {

CommandOutcome run_bevel_surface(const CommandRequest& request, const Job& job, OutputDir& output) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* errors = std::get_if<1>(&made)) return failed(std::move(*errors));
  const BevelGear& gear = std::get<0>(made);
  RunReport report;
  report.command = "surface";
  report.job_name = job.name;
  report.job_file = job.file;
  report.warnings = gear.warnings();
  report.warnings.insert(report.warnings.begin(), job.warnings.begin(), job.warnings.end());
  if (const auto written = write_bevel_files(output, gear, job.name, {}, clock, report.files); !written)
    return failed(located(job, "gear", written.error()));
  report.files.push_back("report.json");
  report.stages = clock.seconds();
  CommandOutcome outcome;
  outcome.report_json = report_json(report);
  if (const auto written = output.write("report.json", outcome.report_json); !written) return failed(written.error());
  progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  outcome.summary = summary_table(report, request.color);
  return outcome;
}

}  // namespace toothpath
