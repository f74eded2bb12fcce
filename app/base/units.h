// Small units of the reports; lengths are in mm and angles in rad everywhere else.
#pragma once

namespace toothpath::app {

inline constexpr double kUm = 1e3;     ///< um in a mm
inline constexpr double kMicro = 1e6;  ///< urad in a rad
constexpr double um(double mm) { return mm * kUm; }

}  // namespace toothpath::app
