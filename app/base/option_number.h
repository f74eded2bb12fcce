// Numbers and units of the command line: the one reader of all of them.
#pragma once

#include <array>
#include <optional>
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

/// Units of length that an option may say.
inline constexpr std::array<std::string_view, 2> kLengthUnits = {"mm", "inch"};
/// mm of such a unit; nothing where the option says none. Refused (kind usage): another word.
[[nodiscard]] Result<std::optional<double>> read_length_unit(std::string_view option, std::string_view text);

}  // namespace toothpath::app
