// The files that describe the finished gear: limits, inspection points and meshes.
#pragma once

#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "cam/proof/verification.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::face {

/// Writes limits.json, limits.html, limits.svg (limits_0.svg, limits_1.svg with two zones), inspection.csv,
/// inspection.dmi, gear.stl (all teeth, sag at most 0.01 mm) and tooth.vtp (one pitch, sag at most 0.002 mm, with the
/// number of the patch at every point) and appends their names to `files`.
/// @param surface as it was cut: then tooth.vtp is that, with its deviation
/// @param assumed values of the machine that nobody measured, for limits.html
[[nodiscard]] Status write_surface_files(app::OutputDir& output, const face_gear::FaceGear& gear,
                                         const std::string& job_name, const std::vector<proof::SurfaceGrid>& surface,
                                         const std::vector<std::string>& assumed, app::StageClock& clock,
                                         std::vector<std::string>& files);

}  // namespace toothpath::face
