// What the axes do while the first tooth of every operation is cut, over time: positions, speeds and the feed of the tool tip.
#pragma once

#include <vector>

#include "app/report/chart.h"
#include "machines/machine.h"
#include "postproc/nc_reader.h"

namespace toothpath {

/// From the program as it was read back. Time runs in minutes from the first known position, tool changes left out; operations follow one
/// another, of each the teeth that were kept. Speeds are the means of the blocks; a rotary's and a linear axis' limit stand as
/// lines where the machine states them. Feed: speed of the tip over the work in feed moves; rapids interrupt the curve.
/// @param motions  of the same read-back, in program order
[[nodiscard]] std::vector<LineChart> motion_charts(const ReadBack& read, const std::vector<ToolMotion>& motions, const Machine& machine);

}  // namespace toothpath
