// How a machine checks the length of a tool: where its setter stands, and the lines that go there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::machines {

/// Least and greatest tolerance of a length, mm.
inline constexpr double kLeastCheckTolerance = 1e-4, kMostCheckTolerance = 10;

/// The table [tool_check] of a machine file.
struct ToolCheck {
  /// Templates with the names of docs/dialects.md in braces; empty: those of the control.
  std::vector<std::string> lines;
  Vec3 position_mm = Vec3::Zero();       ///< machine coordinates: X Y of the spindle, Z where the tip of a tool touches
  double clearance_mm = 10;              ///< above it the way there ends; what follows is the business of the lines
  double feed_mm_min = 100;              ///< towards the setter, where lines name it
  std::optional<double> tolerance_mm;    ///< of tools that state none: a length further off stops the program
  std::optional<double> uncertainty_mm;  ///< the lines let the control take the measured length, which is that far off
  double minutes = 0;                    ///< what a check takes, from the retract ahead of it to that behind it
};

}  // namespace toothpath::machines
