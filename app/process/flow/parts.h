// Programs that hold a part of the teeth each, beside the whole one: their proof against it, and what the report says.
#pragma once

#include <functional>

#include "app/process/program_proof.h"
#include "app/process/program_report.h"
#include "app/report/run_report.h"
#include "postproc/bodies/moves.h"

namespace toothpath::flow {

/// Proves every part against the whole program, which has been proven; its beginning and end on their own, against the
/// part and, by `bodies`, against the bodies of the machine. What is wrong joins the reasons of the report.
/// Errors: what the reader refuses in our own text (kind verification).
[[nodiscard]] Status note_parts(report::RunReport& report, const process::PostedProgram& posted,
                                const process::ProgramText& program, const process::GearCheck& gear,
                                const std::function<bodies::MovesJudge()>& bodies, app::StageClock& clock);

}  // namespace toothpath::flow
