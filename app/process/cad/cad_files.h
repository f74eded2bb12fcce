// A gear for other programs: STEP, 3MF and glTF, blank and roughed part, as a command asks for them.
#pragma once

#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "app/process/gear_process.h"
#include "app/report/cad_report.h"

namespace toothpath::cad {

/// A plan that was made and a program that follows it, for what roughing leaves.
struct Milled {
  const process::GearMilling& milling;
  double off_mm = 0;  ///< proven: the program is no farther from the paths of the plan
};

/// What is asked beside the files that every run of a command writes.
struct FilesAsked {
  bool step = false, three_mf = false, gltf = false, stock = false;
};

/// What there is to tell of the files.
struct Written {
  std::optional<report::CadReport> solid;        ///< none where it was not asked for
  std::optional<report::RoughedReport> roughed;  ///< none where no run asked for it, and where nothing roughs
  std::vector<std::string> warnings;
};

/// Names of all files of this room, for the list of a command's outputs.
[[nodiscard]] const std::vector<std::string>& file_names();

/// Writes gear.step, gear.3mf, gear.glb, blank.stl and roughed.stl (only with `milled`, and where something roughs) as
/// far as they are asked for; what is not asked for costs nothing. Stages "STEP", "3MF", "glTF", "stock". @param files
/// names join it. Refused, at
/// gear: a gear that has no solid (docs/exchange.md).
[[nodiscard]] Result<Written> write_files(const FilesAsked& asked, const job::Job& job,
                                          const process::GearProcess& gear, const std::optional<Milled>& milled,
                                          app::OutputDir& output, app::StageClock& clock,
                                          std::vector<std::string>& files);

}  // namespace toothpath::cad
