// A finished gear as meshes and files, from its tooth spaces: the same for every gear that is milled.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/base/stage_clock.h"
#include "app/process/gear_files.h"
#include "app/process/gear_process.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::milled {

[[nodiscard]] Result<process::FinishedGear> finished_gear(const tooth_space::ToothedSolid& gear);
/// With the facets of gear.stl.
[[nodiscard]] Result<mesh::TriangleMesh> gear_mesh(const tooth_space::ToothedSolid& gear);
[[nodiscard]] Result<mesh::TriangleMesh> pitch_mesh(const tooth_space::ToothedSolid& gear, process::FacetSize size);

/// inspection.csv, gear.stl (all teeth, sag at most 0.01 mm) and tooth.vtp: the surface as it was cut with its
/// deviation; without one, a pitch (sag at most 0.002 mm) with the number of the patch at every point.
[[nodiscard]] Status write_bodies(process::GearFiles& to, const tooth_space::ToothedSolid& gear,
                                  const std::string& job_name,
                                  const std::function<Result<process::InspectedFlanks>()>& inspected,
                                  const std::vector<proof::SurfaceGrid>& surface, app::StageClock& clock);

}  // namespace toothpath::milled
