// What limits a spiral bevel gear and its tools: limits.json, and a chart for the page.
#pragma once

#include <string>

#include "app/report/svg/chart.h"
#include "geometry/spiral_bevel/gear.h"

namespace toothpath::spiral_bevel {

/// limits.json: the zone as of every bevel gear (milled::ring_zone), and what the settings make: the width of the
/// space and the spiral angles on the pitch cone in the middle of the face.
[[nodiscard]] std::string limits_json(const SpiralBevelGear& gear);

/// Top land and root land over the cone distance.
[[nodiscard]] svg::LineChart limit_chart(const SpiralBevelGear& gear);

}  // namespace toothpath::spiral_bevel
