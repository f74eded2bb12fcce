// What describes a bevel gear in files and to posts and sheets: limits, its outline.
#pragma once

#include <string>
#include <vector>

#include "app/report/sheet/data_sheet.h"
#include "app/report/sheet/setup_sheet.h"
#include "cam/tool/assembly.h"
#include "geometry/bevel_gear/gear.h"
#include "postproc/joints/program.h"

namespace toothpath::bevel {

/// The blank as a cylinder about the gear axis.
[[nodiscard]] joints::ClearanceBody clearance_body(const bevel_gear::BevelGear& gear);
/// The same for links: with TCP the tip keeps its height over the part while the tool leans over it, so that the body
/// of the tool reaches below its tip; the cylinder is longer by that at the small end. Without TCP links go over the
/// top of Z, and it is not.
[[nodiscard]] joints::ClearanceBody link_body(const bevel_gear::BevelGear& gear,
                                              const std::vector<tool::ToolAssembly>& tools,
                                              const machines::Machine& machine);
/// The same for the sketch of the set-up sheet.
[[nodiscard]] sheet::PartOutline outline(const bevel_gear::BevelGear& gear);

/// The table of the drawing, for the data sheet.
[[nodiscard]] sheet::DataGroup gear_data(const bevel_gear::BevelGear& gear);

/// limits.json: top_land, space_width, module_limit, tip_flat, corner_fillet_reach [mm], cutter_line_angle [deg], and
/// more.
[[nodiscard]] std::string limits_json(const bevel_gear::BevelGear& gear);

}  // namespace toothpath::bevel
