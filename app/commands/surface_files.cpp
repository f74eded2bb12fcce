#include "app/commands/surface_files.h"

#include "app/commands/gear_files.h"
#include "app/report/limits_chart.h"
#include "app/report/limits_json.h"
#include "app/report/study_page.h"
#include "geometry/inspection_dmis.h"
#include "geometry/inspection_grid.h"

namespace toothpath {
namespace {

constexpr double kStlSag = 0.01, kVtpSag = 0.002;  // mm

/// Number of the patch that the first triangle at each vertex belongs to.
std::vector<double> patch_of_vertices(const ToothMesh& pitch) {
  std::vector<double> field(pitch.mesh.vertices.size(), static_cast<double>(kPatchCount));
  for (std::size_t t = pitch.tags.size(); t-- > 0;)
    for (const auto vertex : pitch.mesh.triangles[t]) field[static_cast<std::size_t>(vertex)] = static_cast<double>(pitch.tags[t].patch);
  return field;
}

Result<std::string> gear_text(const FaceGear& gear, const std::string& job_name) {
  const auto pitch = mesh_tooth_space(gear, kStlSag);
  if (!pitch) return pitch.error();
  return stl_text(*pitch, job_name);
}

Result<std::string> pitch_text(const FaceGear& gear) {
  const auto pitch = mesh_tooth_space(gear, kVtpSag);
  if (!pitch) return pitch.error();
  return vtp_text(pitch->mesh, patch_of_vertices(*pitch));
}

Result<std::string> inspection_text(const FaceGear& gear) {
  const auto points = inspection_grid(gear);
  if (!points) return points.error();
  return inspection_csv(*points);
}

}  // namespace

Status write_surface_files(OutputDir& output, const FaceGear& gear, const std::string& job_name, StageClock& clock,
                           std::vector<std::string>& files, const std::vector<std::string>& assumed) {
  GearFiles to(output, files);
  if (const auto s = to.write("limits.json", limits_json(gear)); !s) return s;
  if (const auto s = to.write("limits.html", limits_page(gear, job_name, assumed)); !s) return s;
  for (std::size_t zone = 0; zone < gear.rings().size(); ++zone)
    if (const auto s = to.write(gear.rings().size() == 1 ? "limits.svg" : "limits_" + std::to_string(zone) + ".svg", standalone_svg(limit_charts(gear)[2 * zone])); !s)
      return s;
  const auto dmis = inspection_grid(gear);
  if (!dmis) return dmis.error();
  if (const auto s = to.write("inspection.dmi", inspection_dmis(gear, *dmis, job_name)); !s) return s;
  if (const auto s = to.write("inspection.csv", clock.run("inspection grid", [&] { return inspection_text(gear); })); !s) return s;
  if (const auto s = to.write("gear.stl", clock.run("mesh", [&] { return gear_text(gear, job_name); })); !s) return s;
  return to.write("tooth.vtp", clock.run("mesh", [&] { return pitch_text(gear); }));
}

}  // namespace toothpath
