// Comments that do something at the control besides telling people. A reader that takes them for comments would prove
// another program than the one that runs. Which ones there are is the business of each control.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/base/result.h"

namespace toothpath::readback {

struct ActingComment {
  int column = 1;    ///< of its text, from 1
  std::string text;  ///< its name and what it does: "(PY, ..) runs its text as Python"
};

/// The first comment of a line that acts; nothing: none does. Lines need not be well-formed.
using FindActingComment = std::optional<ActingComment> (*)(std::string_view line);

/// No line of a program has such a comment, executed or not. @param find null: the control has none
[[nodiscard]] inline Status no_acting_comment(std::string_view text, const std::string& file, FindActingComment find) {
  int number = 0;
  for (std::size_t begin = 0; find != nullptr && begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (auto found = find(text.substr(begin, end - begin)))
      return Diagnostic{DiagnosticKind::refused_input, {file, number + 1, found->column}, std::move(found->text)};
    begin = end + 1;
  }
  return Ok{};
}

}  // namespace toothpath::readback
