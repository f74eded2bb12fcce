#include "app/process/milled/bodies.h"

#include "app/report/deviation_vtp.h"
#include "geometry/inspection/grid.h"
#include "geometry/mesh/tooth_mesh.h"

namespace toothpath::milled {
namespace {

using tooth_space::ToothedSolid;

constexpr double kStlSag = 0.01, kVtpSag = 0.002, kSolidSag = 0.02;  // mm
constexpr double kPictureSag = 0.02;                                 // of the module

Result<std::string> gear_text(const ToothedSolid& gear, const std::string& job_name) {
  const auto pitch = mesh::mesh_tooth_space(gear, kStlSag);
  if (!pitch) return pitch.error();
  return process::stl_text(*pitch, job_name);
}

Result<std::string> pitch_text(const ToothedSolid& gear) {
  const auto pitch = mesh::mesh_tooth_space(gear, kVtpSag);
  if (!pitch) return pitch.error();
  return process::vtp_text(pitch->mesh, patch_of_vertices(*pitch));
}

}  // namespace

Result<process::FinishedGear> finished_gear(const ToothedSolid& gear) {
  const auto pitch = mesh::mesh_tooth_space(gear, kSolidSag);
  if (!pitch) return pitch.error();
  process::FinishedGear out{
      mesh::join_copies(*pitch), {}, [chart = gear.chart(), root = gear.lowest_root](const Vec3& p) {
        return chart.up(p) > root;
      }};
  out.teeth.resize(out.mesh.vertices.size());
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t)
    if (pitch->tags[t % pitch->tags.size()].patch != tooth_space::Piece::body)
      for (const auto vertex : out.mesh.triangles[t]) out.teeth[static_cast<std::size_t>(vertex)] = true;
  return out;
}

Result<mesh::TriangleMesh> gear_mesh(const ToothedSolid& gear) { return mesh::mesh_gear(gear, kStlSag); }

Result<mesh::TriangleMesh> pitch_mesh(const ToothedSolid& gear, process::FacetSize size) {
  auto pitch =
      mesh::mesh_tooth_space(gear, size == process::FacetSize::picture ? kPictureSag * gear.module_mm : kStlSag);
  if (!pitch) return pitch.error();
  return std::move(pitch->mesh);
}

Status write_bodies(process::GearFiles& to, const ToothedSolid& gear, const std::string& job_name,
                    const std::function<Result<process::InspectedFlanks>()>& inspected,
                    const std::vector<proof::SurfaceGrid>& surface, app::StageClock& clock) {
  const auto inspection = clock.run("inspection grid", [&]() -> Result<std::string> {
    const auto flanks = inspected();
    if (!flanks) return flanks.error();
    return inspection_csv(flanks->points, flanks->names);
  });
  if (const auto s = to.write("inspection.csv", inspection); !s) return s;
  if (const auto s = to.write("gear.stl", clock.run("mesh", [&] { return gear_text(gear, job_name); })); !s) return s;
  return to.write("tooth.vtp", clock.run("mesh", [&] {
    return surface.empty() ? pitch_text(gear) : report::deviation_vtp(surface);
  }));
}

}  // namespace toothpath::milled
