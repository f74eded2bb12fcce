#include "app/studies/strategy_jobs.h"

#include <algorithm>

#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"

namespace toothpath::studies {
namespace {

using path::MillingOperation;
using path::OperationType;

SourcePosition place_of(const job::Job& job, std::size_t operation) {
  return job.where(fmt::format("operation[{}]", operation));
}

/// One key for every radius of the gear. Aside counts towards growing azimuth: away from flank +1.
void prescribe(const job::Job& job, const PrescribedLean& lean, MillingOperation& o) {
  const auto& zones = job.face_gear()->zones;
  const double middle = (zones.front().inner_radius_mm + zones.back().outer_radius_mm) / 2;
  o.axis_plus = {{middle, lean.outwards_rad, lean.aside_rad}};
  o.axis_minus = {{middle, lean.outwards_rad, -lean.aside_rad}};
}

}  // namespace

Result<LineMilledFlanks> line_milled_flanks(const job::Job& job) {
  if (job.operations.empty())
    return fail_at(job.where("operation"), "the job lacks an [[operation]]: there is nothing to compare");
  const auto finisher = path::finisher_of(job.operations, path::Region::flank);
  if (!finisher)
    return fail_at(job.where("operation"),
                   "no operation finishes the flanks: the study needs a line_milling without allowance");
  const MillingOperation& last = job.operations[*finisher];
  if (last.type != OperationType::line_milling)
    return fail_at(place_of(job, *finisher),
                   "operation {} finishes the flanks and is a {}: the study compares others with a line_milling, which "
                   "this job lacks there",
                   *finisher, to_string(last.type));
  LineMilledFlanks flanks{*finisher, {}};
  for (std::size_t n = 0; n < job.operations.size(); ++n)
    if (job.operations[n].type == OperationType::line_milling) flanks.operations.push_back(n);
  return flanks;
}

std::string to_string(const PrescribedLean& lean) {
  std::string text;
  if (lean.outwards_rad != 0) text = fmt::format("outwards {:g} deg", degrees(lean.outwards_rad));
  if (lean.aside_rad != 0) text += fmt::format("{}aside {:g} deg", text.empty() ? "" : ", ", degrees(lean.aside_rad));
  return text.empty() ? "upright" : text;
}

job::Job with_strips(job::Job job, const LineMilledFlanks& flanks, int strips) {
  job.operations[flanks.finisher].strips = strips;
  return job;
}

Result<job::Job> with_ball(job::Job job, const LineMilledFlanks& flanks, const PrescribedLean* lean) {
  for (const std::size_t n : flanks.operations) {
    MillingOperation& o = job.operations[n];
    const tool::ToolAssembly& tool = job.tools[std::size_t(o.tool)];
    if (!tool::serves(tool, tool::CutterUse::ball_end))
      return fail_at(place_of(job, n), "tool {} is a {}: it has no ball end to finish a flank with", tool.number,
                     tool::kind_of(tool).word);
    o = path::by_ball_end(o);
    if (o.scallop_mm >= tool.radius_mm())
      return fail_at(place_of(job, n), "a scallop of {:g} mm is not below {:g} mm, the radius of tool {}", o.scallop_mm,
                     tool.radius_mm(), tool.number);
    if (lean && !job.face_gear())
      return fail_at(place_of(job, n),
                     "a lean that is prescribed is a tool_axis, which belongs to face gears; this gear is a {}",
                     job.gear_type());
    if (lean) prescribe(job, *lean, o);
  }
  return job;
}

}  // namespace toothpath::studies
