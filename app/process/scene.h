// Fixture and stock as meshes: `toothpath check JOB PROGRAM --fixture FILE --stock FILE`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/base/stage_clock.h"
#include "app/job/job.h"
#include "app/report/run_report.h"
#include "app/report/scene_report.h"
#include "cam/clearance/distance.h"
#include "cam/proof/verification.h"
#include "machines/machine.h"
#include "postproc/readback/reader.h"

namespace toothpath::process {

struct SceneMesh {
  mesh::TriangleMesh mesh;
  std::unique_ptr<clearance::MeshDistance> distance;
};

/// Meshes in the gear frame W, mm: they stand still about the gear, as bolted to the table that turns it. Each file is
/// a solid of its own.
struct Scene {
  std::vector<std::string> fixture_files, stock_files;
  std::vector<SceneMesh> fixture, stock;
  std::vector<report::MeshInScene> fixture_places, stock_places;  ///< one a mesh: app/process/scene_place
  [[nodiscard]] bool empty() const { return fixture.empty() && stock.empty(); }
};

/// Files of meshes that a request names, each a solid.
struct SceneFiles {
  std::vector<std::string> stock_files, fixture_files;
};

/// Does the request name a mesh?
[[nodiscard]] inline bool wants_scene(const SceneFiles& request) {
  return !request.stock_files.empty() || !request.fixture_files.empty();
}

/// Loads what the request names; nothing is loaded or built when it names nothing. A stock has the teeth of the gear
/// and turns with it; fixtures stay where they are when the gear is turned by `clocking_rad`. Errors: those of
/// load_mesh, located in the file.
[[nodiscard]] Result<Scene> load_scene(const SceneFiles& request, double clocking_rad = 0);

/// What a check of the meshes must know of gear and tools.
struct SceneGear {
  int teeth = 0;
  double clearance_mm = 0;
  std::vector<std::vector<clearance::MeshBody>>
      bodies;  ///< of every tool, by index in the job; empty: a tool that no operation uses
  std::function<double(const Vec3& tip)>
      azimuth;  ///< of a tip in W, less that of the tooth space there: names teeth that no index tells apart
};
/// Executes the program once more and judges every move of every tooth, in the order in which the machine makes them,
/// with the tool that is in the spindle:
/// - fixture: every body, on feeds and rapids, keeps the clearance (proven between the blocks);
/// - stock, as it stood before the program: shank and holder never touch it; on rapids every body keeps the clearance
/// from it. One removal is
///   credited: a rapid that draws the tool back along its own axis from where a feed ended is judged without the room
///   that the cutting part had there.
/// `read`: of the same text; names the teeth.
[[nodiscard]] Result<std::vector<report::SceneVerdict>> check_scene(const Scene& scene, std::string_view text,
                                                                    const std::string& file, const job::Job& job,
                                                                    const machines::Machine& machine,
                                                                    const readback::ReadBack& read,
                                                                    const SceneGear& gear);

/// Why a program does not pass, one line a kind of mesh; empty: it does.
[[nodiscard]] std::vector<std::string> reasons_of(const std::vector<report::SceneVerdict>& verdicts);

/// What the meshes say joins the reasons, the table of the worst places and the report.
void add_scene(std::vector<report::SceneVerdict>& verdicts, std::vector<std::string>& reasons,
               proof::GougeResult& gouge, report::RunReport& report);

}  // namespace toothpath::process
