// Lines of Heidenhain plain text: where a comment begins, and blocks that go on in the next line.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/readback/acting_comment.h"

namespace toothpath::controls {

/// The line up to the comment behind its block, without blanks at its end; the whole line where it is a comment.
[[nodiscard]] std::string_view heidenhain_code(std::string_view line);

/// A comment that ends with ~: the control takes the next line for a part of this block, whatever stands in it.
[[nodiscard]] std::optional<readback::ActingComment> heidenhain_acting_comment(std::string_view line);

/// What joining has made of lines: their texts, and where they stand in the file.
struct JoinedLines {
  std::deque<std::string> texts;
  std::vector<std::int32_t> numbers;  ///< from 1; empty: none was joined
  [[nodiscard]] std::int32_t number(std::size_t line) const {
    if (numbers.empty()) return static_cast<std::int32_t>(line) + 1;
    return line < numbers.size() ? numbers[line] : numbers.back();
  }
};

/// A block whose line ends with ~ goes on in the next one, as the control prints its cycles: they become one line.
[[nodiscard]] JoinedLines join_lines(std::vector<std::string_view>& lines);

}  // namespace toothpath::controls
