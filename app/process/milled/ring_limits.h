// Limits of a gear of one ring of teeth, from its space alone: for limits.json, and a chart for the page.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/report/svg/chart.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::milled {

/// The zone of limits.json: per flank `fillet_radius_min`, `root_ball` (radius), `top_land` [mm], the least over the
/// face, `undercut` (null: a gear that has one is refused), and the curvatures half way up the flank in the middle of
/// the face [1/mm, convex positive], all of the exact surface.
[[nodiscard]] nlohmann::ordered_json ring_zone(const tooth_space::ToothSpace& space);
/// Top land and root land along the teeth.
[[nodiscard]] svg::LineChart land_chart(const tooth_space::ToothSpace& space,
                                        const std::function<double(double s)>& root_land, std::string note);

}  // namespace toothpath::milled
