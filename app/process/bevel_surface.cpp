// `toothpath surface` for a bevel gear.
#include "app/process/bevel_files.h"
#include "app/process/opening_and_end.h"

namespace toothpath::process {

commands::CommandOutcome run_bevel_surface(const commands::JobRequest& request, const job::Job& job, app::OutputDir& output) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* errors = made.refused()) return commands::failed(std::move(*errors));
  const bevel_gear::BevelGear& gear = made.value();
  report::RunReport report = surface_report(job, gear.warnings());
  if (const auto written = write_bevel_files(output, gear, job.name, {}, clock, report.files); !written)
    return commands::failed(located(job, "gear", written.error()));
  progress.clear();
  return finished_report(output, clock, std::move(report), request.color);
}

}  // namespace toothpath::process
