// The manual page toothpath(1).
#pragma once

#include <string>

#include "app/help/command_tree.h"

namespace toothpath::help {

/// As roff with the macros of man(7). @param date of this version, as 2026-11-23
[[nodiscard]] std::string man_page(const Program& program, const std::string& date);

}  // namespace toothpath::help
