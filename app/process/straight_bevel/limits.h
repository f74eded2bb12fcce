// What limits a straight bevel gear and its tools: limits.json, and a chart for the page.
#pragma once

#include <string>

#include "app/report/svg/chart.h"
#include "geometry/straight_bevel/gear.h"

namespace toothpath::straight_bevel {

/// limits.json: per zone and flank `fillet_radius_min`, `root_ball` (radius), `top_land` [mm], the least over the face,
/// `undercut` (null: a gear that has one is refused), and the curvatures half way up the flank in the middle of the
/// face [1/mm, convex positive], all of the exact surface.
[[nodiscard]] std::string limits_json(const StraightBevelGear& gear);

/// Top land and root land over the cone distance.
[[nodiscard]] svg::LineChart limit_chart(const StraightBevelGear& gear);

}  // namespace toothpath::straight_bevel
