#include "app/process/proof_limits.h"

#include <algorithm>
#include <cmath>

#include "app/process/gear_of_job.h"
#include "cam/path/asked_stock.h"
#include "geometry/base/angle.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

constexpr double kProofShare = 0.1;    // of the gouge tolerance
constexpr double kCoarseShare = 0.25;  // of the gouge tolerance: a rounding that is told
constexpr double kSureShare = 0.5;     // of the rounding of one word: some of many places are off by that much

/// The walls of a finger mill are those of its last finishing operation, whatever cuts the root afterwards.
std::optional<double> left_of_fingers(const job::Job& job) {
  std::optional<double> left;
  for (const path::MillingOperation& o : job.operations)
    if (o.type == path::OperationType::finger_finishing) left = o.chord_tolerance_mm + kFingerMargin;
  return left;
}

/// Of a face gear: the last operation must be a finishing one, and each region is judged by the one that finishes it.
path::ByRegion<std::optional<double>> left_in_regions(const job::Job& job) {
  path::ByRegion<std::optional<double>> left;
  if (job.operations.empty() || !job.operations.back().finishes()) return left;
  for (const path::Region region : path::kRegions)
    if (const auto n = path::finisher_of(job.operations, region))
      left[region] = proof::most_left_mm(job.operations[*n], region);
  return left;
}

joints::WordFormat format_of(const machines::Machine& machine) {
  const auto dialect = controls::dialect_of(machine);
  return dialect ? dialect->format : joints::WordFormat{};
}

}  // namespace

proof::ProofLimits proof_limits(const job::Job& job, double proof_mm) {
  proof::ProofLimits limits;
  limits.gouge_mm = job.verify.gouge_tolerance_mm;
  limits.proof_mm = std::min(proof_mm, kProofShare * limits.gouge_mm);
  if (job.verify.clearance_mm) limits.clearance_mm = *job.verify.clearance_mm;
  limits.left_mm = left_of_fingers(job);
  limits.left_in_mm = left_in_regions(job);
  for (const auto& left : limits.left_in_mm.value)
    if (left) limits.left_mm = std::max(limits.left_mm.value_or(0), *left);
  return limits;
}

readback::AskedConditions asked_conditions(const job::Job& job, std::span<const path::ClPath* const> paths) {
  readback::AskedConditions asked;
  asked.tool_checks = job.program.text.checks != text::ToolChecks::none;
  for (const path::MillingOperation& o : job.operations) {
    const double raise = o.chip_load_mm > 0 && !o.finishes() ? path::MillingOperation::kMostRaise : 1;
    const auto tool = static_cast<std::size_t>(o.tool);
    asked.operations.push_back({tool < job.tools.size() ? job.tools[tool].number : 0, o.speed_rpm,
                                raise * o.feed_mm_min,
                                tool < job.tools.size() ? job.tools[tool].sisters : std::vector<int>()});
  }
  for (const path::ClPath* path : paths) {
    const auto n = static_cast<std::size_t>(path->operation);
    if (path->operation < 0 || n >= asked.operations.size()) continue;
    for (const path::ClRecord& r : path->records)
      if (r.kind == path::MoveKind::feed)
        asked.operations[n].feed_mm_min = std::max(asked.operations[n].feed_mm_min, r.feed_mm_min);
  }
  if (job.positions.contains("coolant.mode")) asked.coolant = job.coolant;
  return asked;
}

double word_rounding(const machines::Machine& machine, double radius_mm) {
  const joints::WordFormat format = format_of(machine);
  return 0.5 * (std::pow(10.0, -format.linear_decimals) + radians(std::pow(10.0, -format.rotary_decimals)) * radius_mm);
}

std::vector<Diagnostic> finer_than_the_machine(const job::Job& job, const Taken& taken) {
  if (taken.step_mm == 0) return {};
  std::vector<Diagnostic> out;
  const double path = taken.path_mm, step = taken.step_mm, off = kSureShare * 0.5 * step,
               tolerance = job.verify.gouge_tolerance_mm;
  if (tolerance < path + off)
    out.push_back(located(
        job, "verify.gouge_tolerance",
        fail("gouge_tolerance = {:g} mm is below {:g} mm, what this machine can keep: its control leaves the path by "
             "up to {:g} mm, and words of {:g} mm are {:g} mm off in some blocks; {:g} mm leaves room for every "
             "rounding and for the proof; {}",
             tolerance, path + off, path, step, off, least_gouge_tolerance(taken),
             path > off ? "a smaller post.corner_tolerance (or post.smoothing_tolerance) of the machine file helps, "
                          "where its control keeps it"
                        : "finer increments (post.linear_decimals) help, where the control takes them")));
  const double least = off / (1 - path::kAskedStock);
  for (std::size_t n = 0; n < job.operations.size(); ++n)
    if (const double allowance = job.operations[n].allowance_mm; allowance > 0 && allowance < least)
      out.push_back(
          located(job, fmt::format("operation[{}].allowance", n),
                  fail("allowance = {:g} mm is below {:g} mm, the least that words of {:g} mm can leave: they are {:g} "
                       "mm off in some blocks, and {:g} of the allowance must stay; {:g} mm leaves room for every "
                       "rounding, 0 leaves none",
                       allowance, least, step, off, path::kAskedStock, least_allowance(taken))));
  return out;
}

std::optional<std::string> coarse_words(const job::Job& job, const machines::Machine& machine, double radius_mm) {
  const bool side = std::any_of(job.operations.begin(), job.operations.end(), [](const path::MillingOperation& o) {
    return o.type == path::OperationType::line_milling;
  });
  const double rounding = word_rounding(machine, radius_mm), most = kCoarseShare * job.verify.gouge_tolerance_mm;
  if (!side || rounding <= most) return {};
  const joints::WordFormat format = format_of(machine);
  return fmt::format(
      "words rounded to {:g} mm and {:g} deg cost up to {:.2f} um at radius {:.1f} mm, above {:.2f} um, a quarter of "
      "gouge_tolerance: finer increments (post.linear_decimals, post.rotary_decimals of the machine), or a larger left "
      "and gouge_tolerance",
      std::pow(10.0, -format.linear_decimals), std::pow(10.0, -format.rotary_decimals), 1e3 * rounding, radius_mm,
      1e3 * most);
}

}  // namespace toothpath::process
