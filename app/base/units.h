// Small units of the reports; lengths are in mm and angles in rad everywhere else.
#pragma once

#include <fmt/format.h>

#include <string>

namespace toothpath::app {

inline constexpr double kUm = 1e3;     ///< um in a mm
inline constexpr double kMicro = 1e6;  ///< urad in a rad
constexpr double um(double mm) { return mm * kUm; }

/// A gap in mm that is proven; `at_least`: the true one may be much larger.
inline std::string least_text(double mm, bool at_least) {
  return fmt::format("{}{:.3f}", at_least ? "at least " : "", mm);
}

}  // namespace toothpath::app
