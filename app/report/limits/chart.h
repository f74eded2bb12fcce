// Where the flanks of a face gear end, as plots: top land over the radius with its limits, and the heights of tip,
// fillet line and root.
#pragma once

#include <string>
#include <vector>

#include "app/report/svg/chart.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::limits {

/// Two plots a zone: thickness of the top land over the radius with undercut, involute start, pointing and the zone
/// itself as vertical lines; heights of tip surface, fillet line of each side and root.
[[nodiscard]] std::vector<svg::LineChart> limit_charts(const face_gear::FaceGear& gear);

/// A page of its own with the plots and a table of the limits, which one governs, and every fillet line.
/// @param assumed values of the machine that nobody measured, of a run that writes a program: the page names them
[[nodiscard]] std::string limits_page(const face_gear::FaceGear& gear, const std::string& job_name,
                                      const std::vector<std::string>& assumed = {});

/// "undercut, flank -1": the limit that governs the inner radius of a zone and its side; without side where both share
/// it.
[[nodiscard]] std::string governing_limit(const face_gear::ZoneLimits& limits);

}  // namespace toothpath::limits
