// Numbers of the command line: the one reader of all of them.
#pragma once

#include <string_view>

#include "geometry/base/result.h"
#include "machines/toml/table_reader.h"

namespace toothpath::app {

/// A finite number in the range, in decimal digits with a sign, a point and an exponent where wanted; nothing before or
/// behind it. Refused (kind usage): all else, with the name of the option, the text and the range. `range.unit` is the
/// unit of the text.
[[nodiscard]] Result<double> read_number(std::string_view option, std::string_view text, const toml::Range& range);

/// The same of whole numbers: digits with a sign.
[[nodiscard]] Result<int> read_whole_number(std::string_view option, std::string_view text, const toml::Range& range);

}  // namespace toothpath::app
