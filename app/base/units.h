// Small units of the reports; lengths are in mm and angles in rad everywhere else.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace toothpath::app {

inline constexpr double kUm = 1e3;     ///< um in a mm
inline constexpr double kMicro = 1e6;  ///< urad in a rad
constexpr double um(double mm) { return mm * kUm; }

/// A gap in mm that is proven; `at_least`: the true one may be much larger.
inline std::string least_text(double mm, bool at_least) {
  return fmt::format("{}{:.3f}", at_least ? "at least " : "", mm);
}

/// "12 s" (only with `short_as_seconds`), "4 min 05 s", "6 h 31 min".
inline std::string duration_text(double seconds, bool short_as_seconds = false) {
  const auto s = static_cast<long long>(std::llround(seconds));
  if (short_as_seconds && s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

}  // namespace toothpath::app
