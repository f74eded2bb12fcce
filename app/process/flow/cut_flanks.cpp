#include "app/process/flow/cut_flanks.h"

#include "app/process/flow/registry.h"
#include "app/process/flow/stages.h"
#include "app/process/proof_limits.h"

namespace toothpath::flow {

process::ValueOrErrors<process::CutFlanks> cut_flanks(const job::Job& job, const process::FlankGrid& grid,
                                                      app::OutputDir& scratch, bool quiet) {
  if (job.operations.empty()) {
    if (!job.shaping)
      return std::vector{fail_at(
          job.where(""), "the job has neither an [[operation]] nor the table [shaping]: nothing cuts its flanks")};
    auto made = make_process(job);
    if (auto* errors = made.refused()) return std::move(*errors);
    return made.value()->shaped(grid);
  }
  auto done = run_stages(job, process::proof_limits(job), scratch, quiet, grid);
  if (!done.errors.empty()) return std::move(done.errors);
  process::CutFlanks cut;
  cut.route = "milled";
  cut.flanks = process::flanks_of(done.surface);
  if (cut.flanks.empty()) {
    const std::string reason = done.report.reasons.empty() ? "the run left no surface" : done.report.reasons.front();
    return std::vector{fail_as(DiagnosticKind::verification, "{}", reason)};
  }
  cut.cutting_minutes = done.report.feed_minutes;
  cut.total_minutes = done.report.total_minutes;
  cut.time_model = report::times_text(done.report);
  cut.verified = done.report.verified;
  cut.warnings = done.report.warnings;
  for (const auto& reason : done.report.reasons) cut.warnings.push_back("not verified: " + reason);
  cut.assumed = done.report.assumed;
  cut.stages = done.report.stages;
  return cut;
}

}  // namespace toothpath::flow
