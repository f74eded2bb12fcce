// A CL path as the checks see it: one motion between two records that follow each other.
#pragma once

#include <vector>

#include "cam/path/cl_path.h"
#include "cam/path/tool_motion.h"

namespace toothpath::path {

/// Motions in the order of the records, straight in tip and axis, without deviation; their line is the index of the
/// record where they end. A rapid takes no time.
[[nodiscard]] std::vector<ToolMotion> motions_of(const ClPath& path);

}  // namespace toothpath::path
