// A gear for other programs: STEP, 3MF and glTF, as a command asks for them.
#pragma once

#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "app/process/gear_process.h"
#include "app/report/cad_report.h"

namespace toothpath::cad {

/// What is asked beside the files that every run of a command writes.
struct FilesAsked {
  bool step = false, three_mf = false, gltf = false;
};

/// Names of all files of this room, for the list of a command's outputs.
[[nodiscard]] const std::vector<std::string>& file_names();

/// Writes gear.step, gear.3mf and gear.glb as far as they are asked for; what is not asked for costs nothing. Stages
/// "STEP", "3MF", "glTF". @param files names join it. What the report tells of the solid; none without it. Refused, at
/// gear: a gear that has no solid (docs/exchange.md).
[[nodiscard]] Result<std::optional<report::CadReport>> write_files(const FilesAsked& asked, const job::Job& job,
                                                                   const process::GearProcess& gear,
                                                                   app::OutputDir& output, app::StageClock& clock,
                                                                   std::vector<std::string>& files);

}  // namespace toothpath::cad
