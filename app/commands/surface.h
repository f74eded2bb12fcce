// `toothpath surface`: flanks, limits, mesh and inspection grid of the gear. Plans no path and loads no ray tracer.
#pragma once

#include "app/commands/command.h"
#include "app/job/job.h"
#include "app/process/cad/cad_files.h"

namespace toothpath::commands {

/// Files that the command owns in its output directory.
[[nodiscard]] const std::vector<std::string>& surface_outputs();

/// With files for other programs, as far as they are asked for.
struct SurfaceRequest : JobRequest {
  cad::FilesAsked cad;
  std::string rexs_file;  ///< the gear as REXS; empty: not asked
};
/// --step, --3mf, --gltf, --stock.
void cad_options(OptionSet& set, cad::FilesAsked& asked);

[[nodiscard]] CommandOutcome run_surface(const SurfaceRequest& request);

}  // namespace toothpath::commands
