// The motion curve of one pair of teeth alone, through its whole mesh and on its edges, as numbers and with its
// neighbours as a drawing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/report/svg/chart.h"

namespace toothpath::ease_off {

struct MotionCurve {
  std::string name;                      ///< "flank +1"
  int lags = 1;                          ///< sign of an error that lets the driven member lag
  std::vector<double> phi_2, error_rad;  ///< positions of the roll, rising
  double mean_rad = 0, range_rad = 0;    ///< of all pairs together
  double start = 0, pitch = 1;           ///< turn at which the pitch of the roll begins; rad
};

/// Mean and range of a transmission error, as every report of a pair has them. @param lever_mm  makes lengths of angles
[[nodiscard]] nlohmann::ordered_json transmission_error_json(double mean_rad, double range_rad, double lever_mm);
/// In pitches from where the pair lags least. @param stride  positions to one that is told
[[nodiscard]] nlohmann::ordered_json motion_json(const MotionCurve& curve, std::size_t stride);
/// Each curve with those of the pairs before and behind; empty without curves.
[[nodiscard]] svg::LineChart motion_chart(const std::vector<MotionCurve>& curves);

}  // namespace toothpath::ease_off
