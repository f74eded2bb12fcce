// The tools of a job as bodies of revolution for the 3D view of the report page.
#pragma once

#include "app/report/page/report_page.h"
#include "cam/tool/assembly.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::page {

/// Ball, flute, shank and holder of a ball end mill.
[[nodiscard]] PageTool page_end_mill(const tool::ToolAssembly& tool);

/// Flute, shank and holder of a finger mill; the flute has the profile that it must have for this gear. Without bodies
/// where no such profile exists.
[[nodiscard]] PageTool page_finger_mill(const bevel_gear::BevelGear& gear, const tool::ToolAssembly& tool);

}  // namespace toothpath::page
