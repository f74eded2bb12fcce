// What bevel gears that stand on a BevelBody share: how the commands see their blank; and the limits of any gear of one
// ring of teeth.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/process/milled/toothed_process.h"
#include "app/report/svg/chart.h"
#include "geometry/tooth_space/bevel_body.h"

namespace toothpath::milled {

/// A bevel gear as the commands see it; subtitle and limits are still to be set.
/// @param owner  of the solid's space
[[nodiscard]] ToothedGear bevel_gear(std::shared_ptr<const void> owner,
                                     std::shared_ptr<const tooth_space::ToothedPart> part,
                                     tooth_space::ToothedSolid solid, const tooth_space::BevelBody& body,
                                     const std::string& words);

/// The zone of limits.json: per flank `fillet_radius_min`, `root_ball` (radius), `top_land` [mm], the least over the
/// face, `undercut` (null: a gear that has one is refused), and the curvatures half way up the flank in the middle of
/// the face [1/mm, convex positive], all of the exact surface.
[[nodiscard]] nlohmann::ordered_json ring_zone(const tooth_space::ToothSpace& space);
/// "outside_diameter" and "apex_to_crown", of the large end.
void add_blank(nlohmann::ordered_json& limits, const tooth_space::ToothSpace& space);
/// Top land and root land along the teeth.
[[nodiscard]] svg::LineChart land_chart(const tooth_space::ToothSpace& space,
                                        const std::function<double(double s)>& root_land, std::string note);

}  // namespace toothpath::milled
