// The flanks that a job's operations leave: by its milling operations (the stages of `run`) or by the strokes of its
// gear shaper.
#pragma once

#include "app/base/output_dir.h"
#include "app/job/job.h"
#include "app/process/cut_flanks.h"
#include "app/process/gear_process.h"

namespace toothpath::flow {

/// Runs the job's own route. Milled: plan, post, read back, cut surface on the grid. Refused: what `run` and `shaper`
/// refuse; a job with neither operations nor [shaping]; a run that does not get as far as a surface.
[[nodiscard]] process::ValueOrErrors<process::CutFlanks> cut_flanks(const job::Job& job, const process::FlankGrid& grid,
                                                                    app::OutputDir& scratch, bool quiet);

}  // namespace toothpath::flow
