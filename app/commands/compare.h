// `toothpath compare SHAPED MILLED`: one gear by two routes, deviations on the same places and times side by side.
#pragma once

#include "app/commands/command.h"

namespace toothpath::commands {

struct CompareRequest : JobRequest {
  std::string other_job;
};

/// SHAPED is `job_file`, a job with [shaping]; MILLED is `other_job`, a job with operations of the same gear (its
/// shaper's tip radius may differ: that changes the fillets only). Writes compare.csv, compare.json and compare.html.
/// Refused: what `shaper` and `run` refuse; gears that differ, with key and both values.
[[nodiscard]] CommandOutcome run_compare(const CompareRequest& request);

}  // namespace toothpath::commands
