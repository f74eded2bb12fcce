// Work offsets as presets: CYCL DEF 247.
#pragma once

#include <algorithm>
#include <string_view>

#include "postproc/controls/work_offset.h"

namespace toothpath::controls {

/// Number of a preset: "12" is 12; G54 is 1 .. G59 6, G59.1 7 .. G59.3 9; "G54.1 P3" 3. 0 for other names.
[[nodiscard]] inline int preset_number(std::string_view name) {
  if (const int n = basic_offset(name); n > 0) return n - 53;
  if (const int n = tenth_offset(name); n > 0) return 6 + n;
  if (const int n = extended_offset(name, "G54.1 P"); n > 0) return n;
  return std::max(0, whole_number(name));
}

}  // namespace toothpath::controls
