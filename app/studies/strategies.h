// `toothpath study strategies`: the flanks of one gear by the side of a mill and by its ball, side by side.
#pragma once

#include <optional>

#include "app/commands/command.h"

namespace toothpath::studies {

struct StrategiesRequest : commands::JobRequest {
  std::optional<int> strips;  ///< the most of a flank that are tried; none: one more than the job's own plan has
};

/// Takes a face gear job whose flanks are line milled the whole way of `run`, once for every strategy: as it stands,
/// with more strips, by the ball end of the same tool, and by that ball with a prescribed lean; writes
/// strategies.html and strategies.json. A strategy that is refused or not verified says why and stops no other.
/// Refused: what `run` refuses of gear and machine; flanks that something else finishes.
[[nodiscard]] commands::CommandOutcome study_strategies(const StrategiesRequest& request);

}  // namespace toothpath::studies
