#include "app/base/option_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geometry/base/length_unit.h"
#include "geometry/base/printable.h"

namespace toothpath::app {
namespace {

bool in_range(double number, const toml::Range& range) {
  return (range.open_low ? number > range.low : number >= range.low) &&
         (range.open_high ? number < range.high : number <= range.high);
}

/// The whole text, or nothing. `std::from_chars` takes no plus sign.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Diagnostic refusal(std::string_view option, std::string_view text, const char* what, const toml::Range& range) {
  return fail_as(DiagnosticKind::usage, "{} = {} is not {} from {}{:.12g} to {}{:.12g}{}", option,
                 text.empty() ? "\"\"" : text, what, range.open_low ? "above " : "", range.low,
                 range.open_high ? "below " : "", range.high, range.unit);
}

}  // namespace

Result<double> read_number(std::string_view option, std::string_view text, const toml::Range& range) {
  const auto number = number_in<double>(text);
  if (!number || !std::isfinite(*number) || !in_range(*number, range)) return refusal(option, text, "a number", range);
  return *number == 0 ? 0.0 : *number;
}

Result<int> read_whole_number(std::string_view option, std::string_view text, const toml::Range& range) {
  const auto number = number_in<int>(text);
  if (!number || !in_range(*number, range)) return refusal(option, text, "a whole number", range);
  return *number;
}

Result<std::optional<double>> read_length_unit(std::string_view option, std::string_view text) {
  if (text.empty()) return std::optional<double>();
  if (std::find(kLengthUnits.begin(), kLengthUnits.end(), text) == kLengthUnits.end())
    return fail_as(DiagnosticKind::usage, "{} = {} is neither mm nor inch", option, printable(text));
  return mm_of_unit(text);
}

}  // namespace toothpath::app
