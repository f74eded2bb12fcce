#include "app/commands/surface.h"

#include "app/base/command_data.h"

#include "app/job/file.h"
#include "app/process/flow/stages.h"
#include "app/process/opening_and_end.h"

namespace toothpath::commands {

const std::vector<std::string>& surface_outputs() {
  static const std::vector<std::string> names = {"limits.json",  "limits.html",    "limits.svg",     "limits_0.svg",
                                                 "limits_1.svg", "inspection.csv", "inspection.dmi", "gear.stl",
                                                 "tooth.vtp",    "report.json"};
  return names;
}

CommandOutcome run_surface(const JobRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, surface_outputs(), {request.job_file});
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  auto made = flow::make_gear(job, {}, clock);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const process::GearProcess& gear = *made.value().process;
  report::RunReport report = process::surface_report(job, gear.part().warnings);
  if (const auto written = gear.write_files(*output, {}, {}, clock, report.files); !written)
    return failed(process::located(job, "gear", written.error()));
  const auto limits = output->read_back("limits.json");
  if (!limits) return failed(limits.error());
  progress.clear();
  CommandOutcome outcome = process::finished_report(*output, clock, std::move(report), request.color);
  app::add_data(outcome, "limits", *limits);
  return outcome;
}

void add_surface(Commands& commands) {
  commands.push_back(command_of<JobRequest>("surface", "flanks, limits, inspection grid and mesh of the gear",
                                            job_options, run_surface));
}

}  // namespace toothpath::commands
