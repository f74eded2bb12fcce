// What limits a cylindrical gear and its tools: limits.json, and charts for the page.
#pragma once

#include <string>
#include <vector>

#include "app/report/svg/chart.h"
#include "geometry/cylindrical/gear.h"

namespace toothpath::cylinder {

/// limits.json: per zone and flank `fillet_radius_min`, `root_ball` (radius), `top_land` [mm], `undercut` (null: a gear
/// that has one is refused), and the curvatures half way up the flank [1/mm, convex positive], all of the exact
/// surface.
[[nodiscard]] std::string limits_json(const cylindrical::CylindricalGear& gear);

/// Tooth thickness and space width over the radius, one a zone.
[[nodiscard]] std::vector<svg::LineChart> limit_charts(const cylindrical::CylindricalGear& gear);

}  // namespace toothpath::cylinder
