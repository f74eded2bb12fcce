// `toothpath study merge DIR`: the shards of a study put together.
#pragma once

#include <string>

#include "app/commands/command.h"

namespace toothpath::studies {

struct MergeRequest : commands::CommonRequest {
  std::string directory;
};

/// samples.jsonl of all shards in DIR and what the study makes of them: the same bytes however it was cut. Refused:
/// what samples::merge refuses; a study that this program does not know.
[[nodiscard]] commands::CommandOutcome study_merge(const MergeRequest& request);

}  // namespace toothpath::studies
