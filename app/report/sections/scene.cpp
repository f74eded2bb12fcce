#include <algorithm>

#include "app/report/sections/sections.h"

namespace toothpath::sections {

/// So that a mesh of another unit, or at another place, is seen.
report::Section scene(const report::RunReport& report) {
  report::Section section;
  section.title = "Stock and fixture";
  section.id = "scene";
  section.columns = {"kind", "file", "facets", "X mm", "Y mm", "Z mm", "to the gear mm"};
  for (const report::SceneVerdict& kind : report.scene)
    for (const report::MeshInScene& mesh : kind.meshes) {
      std::vector<std::string> row = {kind.name, mesh.file, std::to_string(mesh.facets)};
      for (int k = 0; k < 3; ++k) row.push_back(fmt::format("{:.6g} to {:.6g}", mesh.low[k], mesh.high[k]));
      row.push_back(fmt::format("{:.3f}", mesh.to_gear_mm));
      section.rows.push_back(std::move(row));
    }
  section.note =
      "Boxes of the files as they were read, in mm and in the gear frame: is that their size and their place? Last: "
      "the gap between the surfaces of the mesh and of the finished gear; below its teeth the gear is as thick as in "
      "gear.stl.";
  if (std::any_of(report.scene.begin(), report.scene.end(), [](const auto& kind) { return kind.name == "stock"; }))
    section.note += " The teeth lie within the stock.";
  return section;
}

}  // namespace toothpath::sections
