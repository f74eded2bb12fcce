// `toothpath study machine-errors JOB`: what errors of the machine cost on the flank. `toothpath study merge DIR`: the
// shards of a study put together.
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

struct MergeRequest : commands::CommonRequest {
  std::string directory;
};

/// samples.jsonl of all shards in DIR and what the study makes of them: the same bytes however it was cut. Refused:
/// what samples::merge refuses; a study that this program does not know.
[[nodiscard]] commands::CommandOutcome study_merge(const MergeRequest& request);

}  // namespace toothpath::studies
