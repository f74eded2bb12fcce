// What every proof of a program begins and ends with, whatever the gear: its text as motions of the tool, and those against the path that was
// asked for.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/job.h"
#include "app/stage_clock.h"
#include "machines/machine.h"
#include "postproc/nc_reader.h"

namespace toothpath {

struct ProgramMotions {
  NcControl control;
  ReadBack read;
  std::vector<ToolMotion> motions;  ///< in program order; all teeth that were kept
};

/// Reads `text` back, stage "read back". A motion is proven to lie within `tolerance_mm` (tip) and `tolerance_rad` (axis) of its straight line.
/// Errors: what the reader refuses, located in `file`.
[[nodiscard]] Result<ProgramMotions> motions_of_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine, int teeth,
                                                        double tolerance_mm, double tolerance_rad, StageClock& clock);

/// The motions against the paths, stage "compare with the path". Records that are not met and ways off the path by more than the tolerances
/// (mm, rad) join `reasons`.
[[nodiscard]] ClComparison compare_with_paths(const std::vector<ToolMotion>& motions, std::span<const ClPath* const> paths, double tolerance_mm,
                                              double tolerance_rad, StageClock& clock, std::vector<std::string>& reasons);

}  // namespace toothpath
