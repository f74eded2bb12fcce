#include "app/commands/surface.h"

#include "app/commands/bevel_run.h"
#include "app/commands/surface_files.h"
#include "app/gear_of_job.h"
#include "app/job_file.h"
#include "app/output_dir.h"
#include "app/report/run_report.h"

namespace toothpath {

const std::vector<std::string>& surface_outputs() {
  static const std::vector<std::string> names = {"limits.json", "limits.html", "limits.", "limits_0.svg", "limits_1.svg", "inspection.csv", "inspection.dmi", "gear.stl", "tooth.vtp", "report.json"};
  return names;
}

CommandOutcome run_surface(const CommandRequest& request) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto output = OutputDir::open(request.out_dir, surface_outputs());
  if (!output) return failed(output.error());
  if (const auto bevel = bevel_job(request.job_file)) return run_bevel_surface(request, *bevel, *output);
  auto read = clock.run("job", [&] { return read_job_file(request.job_file); });
  if (auto* errors = std::get_if<1>(&read)) return failed(std::move(*errors));
  const Job& job = std::get<0>(read);
  auto made = clock.run("gear", [&] { return make_face_gear(job); });
  if (auto* errors = std::get_if<1>(&made)) return failed(std::move(*errors));
  const FaceGear& gear = std::get<0>(made);

  RunReport report;
  report.command = "surface";
  report.job_name = job.name;
  report.job_file = job.file;
  report.warnings = gear.warnings();
  report.warnings.insert(report.warnings.begin(), job.warnings.begin(), job.warnings.end());
  if (const auto written = write_surface_files(*output, gear, job.name, clock, report.files); !written)
    return failed(located(job, "gear", written.error()));

  report.files.push_back("report.json");
  report.stages = clock.seconds();
  CommandOutcome outcome;
  outcome.report_json = report_json(report);
  if (const auto written = output->write("report.json", outcome.report_json); !written) return failed(written.error());
  progress.clear();
  if (const auto committed = output->commit(); !committed) return failed(committed.error());
  outcome.summary = summary_table(report, request.color);
  return outcome;
}

}  // namespace toothpath
