// `toothpath study trace-model JOB`: both section-sweep models of a bevel gear against its envelope.
#pragma once

#include "app/commands/command.h"

namespace toothpath::studies {

struct TraceModelRequest : commands::JobRequest {
  bool quick = false;  ///< the short form
};

/// Writes trace_model.csv (every point), trace_model.json (numbers a wall) and trace_model.html (maps). Refused: a face
/// gear and what BevelGear::make refuses. Quick: a coarser grid.
[[nodiscard]] commands::CommandOutcome study_trace_model(const TraceModelRequest& request);

}  // namespace toothpath::studies
