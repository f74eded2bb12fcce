#include "app/commands/surface.h"

#include "app/commands/opening_and_end.h"
#include "app/commands/surface_files.h"

namespace toothpath {

const std::vector<std::string>& surface_outputs() {
  static const std::vector<std::string> names = {"limits.json", "limits.html", "limits.svg", "limits_0.svg", "limits_1.svg", "inspection.csv", "inspection.dmi", "gear.stl", "tooth.vtp", "report.json"};
  return names;
}

CommandOutcome run_surface(const JobRequest& request) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto output = OutputDir::open(request.out_dir, surface_outputs(), {request.job_file});
  if (!output) return failed(output.error());
  if (const auto bevel = bevel_job(request.job_file)) return run_bevel_surface(request, *bevel, *output);
  auto read = read_face_gear_job(request.job_file, clock);
  if (auto* errors = std::get_if<1>(&read)) return failed(std::move(*errors));
  const auto& [job, gear] = std::get<0>(read);
  RunReport report = surface_report(job, gear.warnings());
  if (const auto written = write_surface_files(*output, gear, job.name, clock, report.files); !written)
    return failed(located(job, "gear", written.error()));
  progress.clear();
  return finished_report(*output, clock, std::move(report), request.color);
}

void add_surface(Commands& commands) {
  commands.push_back(command_of<JobRequest>("surface", "flanks, limits, inspection grid and mesh of the gear", job_options, run_surface));
}

}  // namespace toothpath
