// Lines that check the length of a tool, as a reader meets them: exactly those of the machine, whose numbers are named.
// Shares no code with what writes them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::tool_check {

/// A number of a line, where its template has a name in braces.
struct SaidNumber {
  std::string name;
  double value = 0;
  int column = 1;  ///< of the line, from 1
};

/// The numbers of a line that was made from this template; nothing: it is another one. Blanks at both ends do not
/// count.
[[nodiscard]] std::optional<std::vector<SaidNumber>> numbers_of(std::string_view pattern, std::string_view line);

/// n of a comment "TOOL CHECK Tn ..", in any control's form, block number or not: the lines of a check follow. -1:
/// none.
[[nodiscard]] int checked_tool(std::string_view line);

/// The line without a block number ahead of it (Heidenhain).
[[nodiscard]] std::string_view without_number(std::string_view line);

}  // namespace toothpath::tool_check
