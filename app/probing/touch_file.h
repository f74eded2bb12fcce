// What a probing program logs: a line a touch.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/inspection/touches.h"

namespace toothpath::probing {

/// Lines `number x y z`, blanks, tabs, commas or semicolons between; empty lines and those that begin with #, %, ; or
/// // are passed over, as are words in front that DPRNT writes (T, X, Y, Z). Places as they stand, mm.
/// Refused, with line and column: other columns, numbers that are none.
[[nodiscard]] Result<std::vector<inspection::TouchResult>> parse_touches(std::string_view text,
                                                                         const std::string& file);

}  // namespace toothpath::probing
