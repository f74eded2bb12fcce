// `toothpath study machine-errors JOB`: what errors of the machine cost on the flank.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/commands/command.h"

namespace toothpath::studies {

struct MachineErrorsRequest : commands::JobRequest {
  std::optional<int> samples;  ///< of each error alone, and of all together
  std::optional<int> seed;
  std::string shard;                ///< "i/n"; empty: of the array of Slurm, else all
  std::vector<std::string> errors;  ///< NAME=SIZE
  bool only = false;                ///< of those named
  bool fine = false;                ///< the grid of `run`
};

/// Plans and posts the job as `run` does, once; then each sample of its shard that does not stand in DIR yet. All of
/// them in one shard: merged at once. Refused: what `run` refuses; a directory with another study.
[[nodiscard]] commands::CommandOutcome study_machine_errors(const MachineErrorsRequest& request);

}  // namespace toothpath::studies
