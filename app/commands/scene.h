// Fixture and stock as meshes: `toothpath check JOB PROGRAM --fixture FILE --stock FILE`.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/command.h"
#include "app/job.h"
#include "app/report/scene_report.h"
#include "app/stage_clock.h"
#include "cam/mesh_distance.h"
#include "cam/verification.h"
#include "machines/machine.h"
#include "postproc/nc_reader.h"

namespace toothpath {

/// Meshes in the gear frame W, mm: they stand still about the gear, as bolted to the table that turns it. Each file is a solid of its own.
struct Scene {
  std::vector<std::string> fixture_files, stock_files;
  std::vector<std::unique_ptr<MeshDistance>> fixture, stock;
  std::size_t fixture_facets = 0, stock_facets = 0;
  [[nodiscard]] bool empty() const { return fixture.empty() && stock.empty(); }
};

/// Loads what the request names; nothing is loaded or built when it names nothing. `gear_diameter_mm`: outer diameter of the finished gear.
/// Errors: those of load_mesh, located in the file; a stock that is smaller than the gear.
[[nodiscard]] Result<Scene> load_scene(const CommandRequest& request, double gear_diameter_mm);

/// Executes the program once more and judges every move of every tooth, in the order in which the machine makes them, with the tool that is
/// in the spindle:
/// - fixture: every body, on feeds and rapids, keeps `clearance_mm` (proven between the blocks);
/// - stock, as it stood before the program: shank and holder never touch it; on rapids every body keeps `clearance_mm` from it. One removal is
///   credited: a rapid that draws the tool back along its own axis from where a feed ended is judged without the room that the cutting part
///   had there.
/// `read`: of the same text; names the teeth.
[[nodiscard]] Result<std::vector<SceneVerdict>> check_scene(const Scene& scene, std::string_view text, const std::string& file, const Job& job,
                                                            const Machine& machine, const ReadBack& read, int teeth, double clearance_mm);

/// Why a program does not pass, one line a kind of mesh; empty: it does.
[[nodiscard]] std::vector<std::string> reasons_of(const std::vector<SceneVerdict>& verdicts);

/// A meeting as a row of the table of worst places.
[[nodiscard]] WorstPlace worst_place(const MeshMeeting& meeting, const std::string& what);

}  // namespace toothpath
