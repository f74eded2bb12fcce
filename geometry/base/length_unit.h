// Units of length by the words that files use for them.
#pragma once

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

namespace toothpath {

inline constexpr double kInchMm = 25.4;

/// Millimetres of one unit; upper and lower case, blanks around it. Nothing: the word is no unit of length.
inline std::optional<double> mm_of_unit(std::string_view text) {
  struct Unit {
    std::string_view word;
    double mm;
  };
  static constexpr Unit kUnits[] = {{"mm", 1},           {"millimeter", 1},   {"millimeters", 1}, {"millimetre", 1},
                                    {"millimetres", 1},  {"cm", 10},          {"m", 1000},        {"um", 1e-3},
                                    {"\xC2\xB5m", 1e-3}, {"\xCE\xBCm", 1e-3}, {"micron", 1e-3},   {"microns", 1e-3},
                                    {"nm", 1e-6},        {"in", kInchMm},     {"inch", kInchMm},  {"inches", kInchMm},
                                    {"\"", kInchMm},     {"''", kInchMm},     {"thou", 0.0254},   {"mil", 0.0254},
                                    {"ft", 304.8},       {"feet", 304.8},     {"foot", 304.8},    {"'", 304.8}};
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const Unit& unit : kUnits)
    if (word == unit.word) return unit.mm;
  return std::nullopt;
}

}  // namespace toothpath
