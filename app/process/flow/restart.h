// `run --restart OP:TOOTH`, and the places at which any program can be taken up again.
#pragma once

#include <optional>
#include <vector>

#include "app/job/job.h"
#include "app/process/program_proof.h"
#include "app/process/program_report.h"
#include "app/report/run_report.h"

namespace toothpath::flow {

/// Reads "OP:TOOTH"; nothing for an empty text.
/// Errors (kind usage): not two whole numbers, no such operation in the job, no such tooth.
[[nodiscard]] Result<std::optional<joints::ProgramRestart>> read_restart(const std::string& text, const job::Job& job,
                                                                         int teeth);

/// What the program on the disk adds to the report: order of the teeth, restart points, and where it begins in the
/// middle the proof that it does what the proven whole program does from there on. `program`: the whole one.
/// @param lines lines of the whole program for records of paths; made those of the file, 0 where it has none
/// Errors: what the reader refuses in our own text (kind verification).
[[nodiscard]] Status note_restart(report::RunReport& report, const process::PostedProgram& posted,
                                  const process::ProgramText& program, const process::GearCheck& gear,
                                  std::vector<std::vector<int>>& lines, app::StageClock& clock);

}  // namespace toothpath::flow
