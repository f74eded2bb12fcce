// Degrees exist in job files, machine files and NC text only; everything else is in radians.
#pragma once

#include <numbers>

namespace toothpath {

inline constexpr double kPi = std::numbers::pi;
constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace toothpath
