// For controls whose sub-programs take no argument: a tooth as stretches in which the index rotary stands still.
#pragma once

#include <string_view>
#include <vector>

#include "postproc/joints/program.h"

namespace toothpath::text {

/// Blocks [first, last) of one tooth.
struct NcStretch {
  std::size_t first = 0, last = 0;
};

/// Each stretch begins with its rotary block. @param index_axis which word is the index rotary's
/// Errors: the tooth does not begin with a rotary block, or the index rotary moves elsewhere; names the dialect.
[[nodiscard]] Result<std::vector<NcStretch>> stretches_of(const std::vector<joints::AxisBlock>& tooth, int index_axis,
                                                          std::string_view dialect);

}  // namespace toothpath::text
