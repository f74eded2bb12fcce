// What the axes do while the first tooth of every operation is cut, over time: positions, speeds and the feed of the
// tool tip.
#pragma once

#include <vector>

#include "app/report/svg/chart.h"
#include "cam/path/cl_path.h"
#include "machines/machine.h"
#include "postproc/readback/reader.h"

namespace toothpath::page {

/// From the program as it was read back. Time runs in minutes from the first known position, tool changes left out;
/// operations follow one another, of each the teeth that were kept. Two charts an axis: positions in machine
/// coordinates, with a gap where a rapid goes far from where the axis cuts, and the mean speed of every block that
/// feeds, with the axis' limit where it comes near. An axis that stands still while cutting has no chart; the note of
/// the last chart says where it stands. That chart is the feed: speed of the tip over the work in feed moves; rapids
/// interrupt the curve.
/// @param motions  of the same read-back, in program order
[[nodiscard]] std::vector<svg::LineChart> motion_charts(const readback::ReadBack& read,
                                                        const std::vector<path::ToolMotion>& motions,
                                                        const machines::Machine& machine);

/// For every record of `path` the line of the program whose move reaches it, 0 where none does within `tolerance_mm`:
/// lets the page jump from a place on the path to the text. `motions` in program order; those of the first tooth of the
/// path's operation are looked at.
[[nodiscard]] std::vector<int> lines_of_records(const path::ClPath& path, const std::vector<path::ToolMotion>& motions,
                                                double tolerance_mm);

}  // namespace toothpath::page
