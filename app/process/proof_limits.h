// From a job to the limits that its program must keep.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/least_values.h"
#include "cam/proof/limits.h"
#include "machines/machine.h"
#include "postproc/readback/conditions.h"

namespace toothpath::process {

/// mm above the chord tolerance that may stand on a surface finished with a finger mill: rounding, axis motion and the
/// grid of the measurement.
inline constexpr double kFingerMargin = 1.5e-3;

/// @param proof_mm how far a proven bound may lie above what was measured; no more than a tenth of the gouge tolerance
/// is taken
[[nodiscard]] proof::ProofLimits proof_limits(const job::Job& job, double proof_mm = proof::ProofLimits{}.proof_mm);

/// Tool, speed, feed and coolant that the job asks of every operation. Feed of the tip: that of the job, with what a
/// chip load may raise it by; where the path is known, its own if that is more.
[[nodiscard]] readback::AskedConditions asked_conditions(const job::Job& job,
                                                         std::span<const path::ClPath* const> paths = {});

/// What rounding the words of a machine's programs may cost at this radius about the gear axis, mm.
[[nodiscard]] double word_rounding(const machines::Machine& machine, double radius_mm);

/// Tolerances and allowances that no program of this machine can keep: what its control leaves of the path and the
/// rounding of the words X Y Z are more. Located at their keys; none where a program may keep them.
[[nodiscard]] std::vector<Diagnostic> finer_than_the_machine(const job::Job& job, const Taken& taken);

/// What the rounding costs the flanks of a line-milled gear, where that is much of the gouge tolerance; nothing where
/// it is not, and for other gears.
[[nodiscard]] std::optional<std::string> coarse_words(const job::Job& job, const machines::Machine& machine,
                                                      double radius_mm);

}  // namespace toothpath::process
