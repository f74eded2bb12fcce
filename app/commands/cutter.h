// `toothpath cutter JOB`: designs the finger mill for a bevel gear, draws and tabulates it, and judges the mills that
// are there.
#pragma once

#include "app/commands/command.h"

namespace toothpath::commands {

struct CutterRequest : JobRequest {
  std::optional<int> tool_number;  ///< none: the designed mill
  std::string other_job;
};

/// Writes cutter.csv (profile), cutter.svg and cutter.dxf (section), cutter.html (one A4 page) and cutter.json (every
/// condition with value, limit and verdict). `request.tool_number` draws that tool of the job instead of the designed
/// mill, `request.other_job` judges the mills of another job as they were made for its gear. Refused: a face gear, a
/// gear that no mill of the design rules makes, a tool number that the job lacks.
[[nodiscard]] CommandOutcome run_cutter(const CutterRequest& request);

}  // namespace toothpath::commands
