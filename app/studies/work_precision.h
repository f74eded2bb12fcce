// `toothpath study work-precision`: what a tolerance costs, and what it buys.
#pragma once

#include "app/commands/command.h"

namespace toothpath::studies {

struct WorkPrecisionRequest : commands::JobRequest {
  bool quick = false;  ///< the short form
};

/// Runs the stages of `run` on the job again and again, its chord tolerance, its scallop height and the tolerance of
/// the proof varied one at a time and all together by factors over two decades around the job's values, and writes
/// work_precision.csv, work_precision.json, work_precision.html, work_precision.svg and report.html: the page of the
/// job's own run with these plots in it. Refused: what `run` refuses, and bevel gears. With `request.quick` only three
/// factors and no diagonal.
[[nodiscard]] commands::CommandOutcome study_work_precision(const WorkPrecisionRequest& request);

}  // namespace toothpath::studies
