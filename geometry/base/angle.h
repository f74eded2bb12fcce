// Degrees exist in job files, machine files and NC text only; everything else is in radians.
#pragma once

#include <cmath>
#include <numbers>

namespace toothpath {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2 * kPi;
inline constexpr double kDegree = kPi / 180;  ///< in rad
constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }
/// The same direction in [-pi, pi].
[[nodiscard]] inline double wrapped(double angle) { return std::remainder(angle, kTwoPi); }

}  // namespace toothpath
