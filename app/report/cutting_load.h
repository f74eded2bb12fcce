// Force and deflection of one operation as reports tell them. docs/force.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cam/force/load.h"

namespace toothpath::report {

struct CuttingLoad {
  std::optional<force::OperationLoad> load;     ///< none: not computed
  std::optional<force::Compliance> compliance;  ///< mm/N where the tool cuts; told without a load, too
  std::string not_computed;                     ///< why there is no load
  std::optional<double> stock_mm;               ///< that the force is for; none in full material
  std::optional<double> may_leave_mm;           ///< beside what it was asked to leave; none: no such number
  bool slender = false;                         ///< bends by more than that
};

/// A roughing mill in the material along its path, as planned: one entry a feed motion, vectors of one length.
struct EngagementReport {
  int operation = 0;
  std::vector<double> way_mm, engaged_rad, chip_mm, feed_mm_min;
  double step_over_mm = 0;  ///< of its layers, as planned
  double beside_rad = 0;    ///< greatest angle but in the passes that open a layer
  double opening_mm = 0;    ///< way of those
};

/// A number that is an estimate, in few digits.
[[nodiscard]] inline std::string estimate(double value) {
  return fmt::format("{:.{}f}", value, value >= 100 ? 0 : value >= 10 ? 1 : value >= 0.1 ? 2 : 4);
}

}  // namespace toothpath::report
