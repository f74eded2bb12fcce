// The contour deviation that the text allows the control: a share of the tolerance, chosen so that the time is least.
#pragma once

#include <optional>

#include "app/process/program_report.h"

namespace toothpath::flow {

/// What the control is granted beyond the narrow tolerance that `posted` was written with, mm; nothing: no more than
/// that. Of the shares of what is left the smallest whose cutting time is within a thousandth of that of the largest;
/// where the machine file states no accelerations the time depends on none, and it is the half.
/// @param left_mm between what `posted` is proven to keep and the tolerance
[[nodiscard]] std::optional<double> contour_to_grant(const process::PostRequest& request,
                                                     const process::PostedProgram& posted, double left_mm);

/// A contour tolerance of the job that does not fit: what would, in its place. Nothing: the program exceeds its
/// tolerance without it, too. @param over_mm by how much it exceeds its tolerance
[[nodiscard]] std::optional<Diagnostic> contour_refusal(const process::PostRequest& request,
                                                        const process::PostedProgram& posted, double over_mm);

}  // namespace toothpath::flow
