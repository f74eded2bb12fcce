#include "app/process/face/surface_files.h"

#include "app/process/gear_files.h"
#include "app/report/deviation_vtp.h"
#include "app/report/limits/chart.h"
#include "app/report/limits/json.h"
#include "app/report/page/study_page.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/dmis.h"
#include "geometry/inspection/grid.h"

namespace toothpath::face {
namespace {

constexpr double kVtpSag = 0.002;  // mm

Result<std::string> gear_text(const face_gear::FaceGear& gear, const std::string& job_name) {
  const auto pitch = mesh::mesh_tooth_space(drawn_solid(gear), kStlSag);
  if (!pitch) return pitch.error();
  return process::stl_text(*pitch, job_name);
}

Result<std::string> pitch_text(const face_gear::FaceGear& gear) {
  const auto pitch = mesh::mesh_tooth_space(drawn_solid(gear), kVtpSag);
  if (!pitch) return pitch.error();
  return process::vtp_text(pitch->mesh, patch_of_vertices(*pitch));
}

Result<std::string> inspection_text(const face_gear::FaceGear& gear) {
  const auto points = inspection::inspection_grid(drawn_solid(gear));
  if (!points) return points.error();
  return inspection_csv(*points);
}

}  // namespace

Status write_surface_files(app::OutputDir& output, const face_gear::FaceGear& gear, const std::string& job_name,
                           const std::vector<proof::SurfaceGrid>& surface, const std::vector<std::string>& assumed,
                           app::StageClock& clock, std::vector<std::string>& files) {
  process::GearFiles to(output, files);
  if (const auto s = to.write("limits.json", limits::limits_json(gear)); !s) return s;
  if (const auto s = to.write("limits.html", limits::limits_page(gear, job_name, assumed)); !s) return s;
  for (std::size_t zone = 0; zone < gear.rings().size(); ++zone)
    if (const auto s = to.write(gear.rings().size() == 1 ? "limits.svg" : "limits_" + std::to_string(zone) + ".svg",
                                page::standalone_svg(limits::limit_charts(gear)[2 * zone]));
        !s)
      return s;
  const auto dmis = inspection::inspection_grid(drawn_solid(gear));
  if (!dmis) return dmis.error();
  if (const auto s = to.write("inspection.dmi", inspection::inspection_dmis(gear, *dmis, job_name)); !s) return s;
  if (const auto s = to.write("inspection.csv", clock.run("inspection grid", [&] { return inspection_text(gear); }));
      !s)
    return s;
  if (const auto s = to.write("gear.stl", clock.run("mesh", [&] { return gear_text(gear, job_name); })); !s) return s;
  return to.write("tooth.vtp", clock.run("mesh", [&] {
    return surface.empty() ? pitch_text(gear) : report::deviation_vtp(surface);
  }));
}

}  // namespace toothpath::face
