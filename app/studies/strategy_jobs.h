// One gear by several ways of cutting its flanks: jobs that differ from a line-milled one in that alone.
#pragma once

#include <string>
#include <vector>

#include "app/job/job.h"
#include "geometry/base/result.h"

namespace toothpath::studies {

/// The line-milled flanks of a job, by index of its operations.
struct LineMilledFlanks {
  std::size_t finisher = 0;             ///< leaves the finished flank
  std::vector<std::size_t> operations;  ///< all that mill the flank with the side of a mill, in order
};
/// Refused, each with its place: a job without operations; flanks that something else than a line_milling finishes.
[[nodiscard]] Result<LineMilledFlanks> line_milled_flanks(const job::Job& job);

/// A lean that is prescribed on both flanks: outwards along the teeth, and aside, away from the flank that is cut.
struct PrescribedLean {
  double outwards_rad = 0, aside_rad = 0;
};
/// "outwards 10 deg, aside 10 deg"
[[nodiscard]] std::string to_string(const PrescribedLean& lean);

/// The job with so many strips a flank, 1 to path::kMostStrips, where the line finishes.
[[nodiscard]] job::Job with_strips(job::Job job, const LineMilledFlanks& flanks, int strips);

/// The job with every line operation on the flanks by the ball end of its tool: the finishing one at a scallop of its
/// `left`, the others as semi-finishing with their allowance and cusps as above. Tool, speed, feed and chord tolerance
/// stay. Refused (with its place): a tool without a ball end, a scallop that is not below its radius, a lean of another
/// gear than a face gear.
/// @param lean  of the tool axis; none: the planner chooses
[[nodiscard]] Result<job::Job> with_ball(job::Job job, const LineMilledFlanks& flanks, const PrescribedLean* lean);

}  // namespace toothpath::studies
