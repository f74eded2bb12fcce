// An input that another program wrote, as text.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath::toml {

/// The bytes of an input (regular_file.h) as `plain_text` makes them: UTF-16 and any ends of lines are read.
[[nodiscard]] Result<std::string> read_input_text(const std::string& path, std::size_t max_bytes);

}  // namespace toothpath::toml
