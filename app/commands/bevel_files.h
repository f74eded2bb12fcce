// The files that describe a finished bevel gear: limits, inspection points and meshes; and its outline for posts and sheets.
#pragma once

#include <string>
#include <vector>

#include "app/output_dir.h"
#include "app/report/setup_sheet.h"
#include "app/stage_clock.h"
#include "cam/verification.h"
#include "geometry/bevel_gear.h"
#include "postproc/axis_program.h"

namespace toothpath {

/// The blank as a cylinder about the gear axis.
[[nodiscard]] ClearanceBody bevel_clearance_body(const BevelGear& gear);
/// The same for links: with TCP the tip keeps its height over the part while the tool leans over it, so that the body of the tool reaches below
/// its tip; the cylinder is longer by that at the small end. Without TCP links go over the top of Z, and it is not.
[[nodiscard]] ClearanceBody bevel_link_body(const BevelGear& gear, const std::vector<ToolAssembly>& tools, const Machine& machine);
/// The same for the sketch of the set-up sheet.
[[nodiscard]] PartOutline bevel_outline(const BevelGear& gear);

/// limits.json: top_land, space_width, module_limit, tip_flat, corner_fillet_reach [mm], cutter_line_angle [deg], and more.
[[nodiscard]] std::string bevel_limits_json(const BevelGear& gear);

/// Writes limits.json, inspection.csv, gear.stl (all teeth) and tooth.vtp (with `walls`: the measured walls and their deviation in
/// um; without: one pitch with the number of the patch) and appends their names to `files`.
[[nodiscard]] Status write_bevel_files(OutputDir& output, const BevelGear& gear, const std::string& job_name, const std::vector<SurfaceGrid>& walls,
                                       StageClock& clock, std::vector<std::string>& files);

}  // namespace toothpath
