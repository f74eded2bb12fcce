// The place of a rotary that has turned far, for people.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace toothpath::svg {

/// Beyond so many degrees the whole turns are told apart.
inline constexpr double kTurnsFrom = 720;

/// Degrees of a rotary; beyond two turns what is left of one, and the whole turns: "-0.740 (-354 turns)".
[[nodiscard]] inline std::string turned_text(double degrees, int decimals = 3) {
  if (!(std::abs(degrees) > kTurnsFrom)) return fmt::format("{:.{}f}", degrees, decimals);
  const double turns = std::trunc(degrees / 360);
  return fmt::format("{:.{}f} ({:+.0f} turns)", degrees - 360 * turns, decimals, turns);
}

}  // namespace toothpath::svg
