// What bevel gears that stand on a BevelBody share: how the commands see their blank.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/process/milled/toothed_process.h"
#include "geometry/tooth_space/bevel_body.h"

namespace toothpath::milled {

/// A bevel gear as the commands see it; subtitle and limits are still to be set.
/// @param owner  of the solid's space
[[nodiscard]] ToothedGear bevel_gear(std::shared_ptr<const void> owner,
                                     std::shared_ptr<const tooth_space::ToothedPart> part,
                                     tooth_space::ToothedSolid solid, const tooth_space::BevelBody& body,
                                     const std::string& words);

/// Blank and pitch cone as ISO 23509 names them, from the space and the cone distances of its ends.
[[nodiscard]] std::vector<sheet::DataRow> bevel_blank_data(const tooth_space::ToothSpace& space, double pitch_angle_rad,
                                                           double root_angle_rad, double root_depth_outer_mm);

/// "outside_diameter" and "apex_to_crown", of the large end.
void add_blank(nlohmann::ordered_json& limits, const tooth_space::ToothSpace& space);

}  // namespace toothpath::milled
