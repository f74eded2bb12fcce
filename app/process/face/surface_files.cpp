#include "app/process/face/surface_files.h"

#include "app/process/milled/bodies.h"
#include "app/report/limits/chart.h"
#include "app/report/limits/json.h"
#include "app/report/page/study_page.h"
#include "geometry/face_gear/part.h"
#include "geometry/inspection/dmis.h"
#include "geometry/inspection/grid.h"

namespace toothpath::face {
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
  return milled::write_bodies(
      to, drawn_solid(gear), job_name, [&] { return milled::inspection_text(drawn_solid(gear)); }, surface, clock);
}

}  // namespace toothpath::face
