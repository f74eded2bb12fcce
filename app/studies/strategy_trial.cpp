#include "app/studies/strategy_trial.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/process/flow/stages.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "geometry/base/angle.h"

namespace toothpath::studies {
namespace {

LeftOnFlanks left_on_flanks(const std::vector<proof::SurfaceGrid>& surface) {
  LeftOnFlanks left;
  double sum = 0;
  for (const auto& grid : surface) {
    if (path::region_of(grid.patch) != path::Region::flank || grid.excess_um.empty()) continue;
    for (std::size_t k = 0; k < grid.points.size(); ++k) {
      if (!grid.reachable[k]) continue;
      const double excess = double(grid.excess_um.back()[k]) / 1000;
      left.max_mm = left.points == 0 ? excess : std::max(left.max_mm, excess);
      left.min_mm = left.points == 0 ? excess : std::min(left.min_mm, excess);
      sum += excess * excess;
      ++left.points;
    }
  }
  if (left.points > 0) left.rms_mm = std::sqrt(sum / double(left.points));
  return left;
}

int passes_of(const path::ClPath& path) {
  std::set<std::pair<int, int>> passes;  // zone and number
  for (const auto& record : path.records)
    if (record.kind == path::MoveKind::feed) passes.insert({record.zone, record.pass});
  return int(passes.size());
}

/// "13.7 to 20.4 deg", or one number where both read the same.
std::string range_text(double least_rad, double greatest_rad) {
  const std::string least = fmt::format("{:.1f}", degrees(least_rad)),
                    greatest = fmt::format("{:.1f}", degrees(greatest_rad));
  return (least == greatest ? least : least + " to " + greatest) + " deg";
}

/// "turning, 13.7 to 20.4 deg": over all zones.
std::string axis_text(const std::vector<proof::DirectionChoice>& directions, std::size_t operation) {
  bool turns = false, any = false;
  double least = INFINITY, greatest = 0;
  for (const auto& d : directions) {
    if (std::size_t(d.operation) != operation) continue;
    any = true;
    turns = turns || (!d.fixed && d.turning_passes > 0);
    least = std::min(least, d.fixed ? d.lean_rad : d.least_lean_rad);
    greatest = std::max(greatest, d.fixed ? d.lean_rad : d.greatest_lean_rad);
  }
  if (!any) return {};
  return fmt::format("{}, {}", turns ? "turning" : "still in every pass", range_text(least, greatest));
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const auto& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

double seconds_of(const report::RunReport& report) {
  double sum = 0;
  for (const auto& stage : report.stages) sum += stage.second;
  return sum;
}

/// What the run found goes to the trial.
void take_over(flow::Run& run, const LineMilledFlanks& flanks, StrategyTrial& trial) {
  for (const path::ClPath* path : run.paths())
    if (std::size_t(path->operation) == flanks.finisher) trial.passes = passes_of(*path);
  trial.left = left_on_flanks(run.surface);
  trial.proven = trial.left.points > 0;
  trial.report = std::move(run.report);
  trial.tool_axis = axis_text(trial.report.directions, flanks.finisher);
  for (const auto& o : trial.report.operations) {
    const auto n = std::size_t(o.operation);
    if (std::find(flanks.operations.begin(), flanks.operations.end(), n) != flanks.operations.end())
      trial.flank_minutes += o.minutes();
    if (n == flanks.finisher) trial.finish_minutes = o.minutes();
  }
  trial.reason = joined(trial.report.reasons);
  trial.seconds = seconds_of(trial.report);
}

}  // namespace

const report::CuttingLoad* StrategyTrial::cutting() const {
  for (const auto& o : report.operations)
    if (std::size_t(o.operation) == finisher && o.cutting) return &*o.cutting;
  return nullptr;
}

Expected<StrategyTrial, std::vector<Diagnostic>> try_strategy(const std::string& name, const job::Job& job,
                                                              const LineMilledFlanks& flanks, app::OutputDir& scratch,
                                                              bool quiet) {
  StrategyTrial trial;
  trial.name = name;
  trial.finisher = flanks.finisher;
  flow::Run run(quiet);
  run.progress.label(name);
  run.job = job;
  if (auto errors = flow::prepare(run, {}); !errors.empty()) return errors;
  if (const auto stopped = flow::plan_post_and_prove(run, scratch, process::proof_limits(job))) {
    if (stopped->kind == DiagnosticKind::file_access) return std::vector{*stopped};
    run.report.reasons.push_back(stopped->message);
    run.report.verified = false;
  }
  process::discard_program(scratch);
  run.report.stages = run.clock.seconds();
  run.progress.clear();
  take_over(run, flanks, trial);
  return trial;
}

StrategyTrial refused_strategy(const std::string& name, const Diagnostic& why) {
  StrategyTrial trial;
  trial.name = name;
  trial.reason = why.message;
  return trial;
}

}  // namespace toothpath::studies
