// The syntax of job files and study files, and what they say about a key that they do not take.
#pragma once

#include "machines/toml/table_reader.h"

namespace toothpath::job {

inline constexpr toml::TomlSyntax kJobSyntax{.max_nesting = 32, .one_line_strings = true};

/// Keys by themselves ("teeth = 1 is below 2"), tables in brackets; a misspelt key brings the nearest known one.
[[nodiscard]] const toml::TableWords& job_words();

}  // namespace toothpath::job
