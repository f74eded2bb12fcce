// Surface that the ball of a finishing operation does not reach: what is said of it, and when it is a verdict
// (docs/proof.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/finding.h"
#include "cam/proof/verification.h"

namespace toothpath::milled {

/// What was left stands beside the verdict ("verified, root not finished"); report.json tells it in any case.
[[nodiscard]] report::Finding unreached_of(const proof::UnreachedResult& unreached);

/// On an active flank always a reason, elsewhere above `limit_mm`, what the job allows; none: it is told, no verdict.
void judge_unreached(const proof::UnreachedResult& unreached, std::optional<double> limit_mm,
                     std::vector<std::string>& reasons);

}  // namespace toothpath::milled
