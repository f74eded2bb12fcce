// `toothpath surface` for a bevel gear.
#include "app/commands/bevel_files.h"
#include "app/commands/opening_and_end.h"

namespace toothpath {

CommandOutcome run_bevel_surface(const JobRequest& request, const Job& job, OutputDir& output) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* errors = std::get_if<1>(&made)) return failed(std::move(*errors));
  const BevelGear& gear = std::get<0>(made);
  RunReport report = surface_report(job, gear.warnings());
  if (const auto written = write_bevel_files(output, gear, job.name, {}, clock, report.files); !written)
    return failed(located(job, "gear", written.error()));
  progress.clear();
  return finished_report(output, clock, std::move(report), request.color);
}

}  // namespace toothpath
