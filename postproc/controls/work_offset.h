// The names of work offsets: what kind of name it is, and its number. Which ones a control has is said in its folder.
#pragma once

#include <string_view>

namespace toothpath::controls {

/// Whole number above 0, without leading zeros, that is all of the text; -1: it is none.
[[nodiscard]] int whole_number(std::string_view text);
/// 54 to 59 of G54 to G59; -1: the name is none of these.
[[nodiscard]] int basic_offset(std::string_view name);
/// 1 to 3 of G59.1 to G59.3; -1: the name is none of these.
[[nodiscard]] int tenth_offset(std::string_view name);
/// n of the prefix and n: "G54.1 P3" with the prefix "G54.1 P"; -1: the name is none of these.
[[nodiscard]] int extended_offset(std::string_view name, std::string_view prefix);

}  // namespace toothpath::controls
