// The tools of a job as bodies of revolution for the 3D view of the report page.
#pragma once

#include "app/report/report_page.h"
#include "cam/cutter.h"
#include "geometry/bevel_gear.h"

namespace toothpath {

/// Ball, flute, shank and holder of a ball end mill.
[[nodiscard]] PageTool page_ball_mill(const ToolAssembly& tool);

/// Flute, shank and holder of a finger mill; the flute has the profile that it must have for this gear. Without bodies where
/// no such profile exists.
[[nodiscard]] PageTool page_finger_mill(const BevelGear& gear, const ToolAssembly& tool);

}  // namespace toothpath
