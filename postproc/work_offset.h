// The names of work offsets: which ones a dialect has, and their numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace toothpath {

/// Number of a preset (Heidenhain: CYCL DEF 247): "12" is 12; G54 is 1 .. G59 6, G59.1 7 .. G59.3 9; "G54.1 P3" 3. 0 for other names.
[[nodiscard]] int preset_number(std::string_view name);

/// Nothing: the dialect has this work offset. Else the ones that it has, as text: "G54 to G57 and G505 to G599".
[[nodiscard]] std::optional<std::string> other_work_offsets(std::string_view dialect, std::string_view name);

}  // namespace toothpath
