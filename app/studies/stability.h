// `toothpath study stability`: the extreme cases of gears and machines in double and in 50 digits.
#pragma once

#include "app/commands/command.h"

namespace toothpath::studies {

struct StabilityRequest : commands::CommonRequest {
  std::string out_dir;
};

/// Runs every extreme case and writes stability.csv, stability.json and stability.html. Exit code 0 only when every
/// verdict is fine: no NaN, no wrong sheet, no error beyond rounding, every refusal with its reason; else 1. Needs no
/// job.
[[nodiscard]] commands::CommandOutcome study_stability(const StabilityRequest& request);

}  // namespace toothpath::studies
