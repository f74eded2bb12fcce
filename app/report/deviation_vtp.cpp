#include "app/report/deviation_vtp.h"

#include <sstream>

#include "geometry/mesh/file.h"

namespace toothpath::report {

Result<std::string> deviation_vtp(const std::vector<proof::SurfaceGrid>& grids) {
  mesh::TriangleMesh mesh;
  std::size_t operations = 0;
  for (const auto& g : grids) operations = std::max(operations, g.excess_um.size());
  std::vector<std::vector<double>> deviation(operations);
  std::vector<double> reachable, zone;
  for (const auto& g : grids) {
    const auto first = mesh.vertices.size();
    const auto index = [&](int row, int column) {
      return static_cast<int>(first + static_cast<std::size_t>(row) * static_cast<std::size_t>(g.columns) +
                              static_cast<std::size_t>(column));
    };
    // Seen from outside the material the corners run counter-clockwise; which way round the rows lie tells the first
    // cell.
    bool flip = false;
    if (g.rows > 1 && g.columns > 1) {
      const auto c = static_cast<std::size_t>(g.columns);
      flip = (g.points[c] - g.points[0]).cross(g.points[1] - g.points[0]).dot(g.normals[0]) < 0;
    }
    mesh.vertices.insert(mesh.vertices.end(), g.points.begin(), g.points.end());
    for (int row = 0; row + 1 < g.rows; ++row)
      for (int column = 0; column + 1 < g.columns; ++column) {
        const auto a = index(row, column), b = index(row + 1, column), c = index(row + 1, column + 1),
                   d = index(row, column + 1);
        if (flip) {
          mesh.triangles.push_back({a, c, b});
          mesh.triangles.push_back({a, d, c});
        } else {
          mesh.triangles.push_back({a, b, c});
          mesh.triangles.push_back({a, c, d});
        }
      }
    for (std::size_t n = 0; n < operations; ++n)
      deviation[n].insert(deviation[n].end(), g.excess_um[n].begin(), g.excess_um[n].end());
    reachable.insert(reachable.end(), g.reachable.begin(), g.reachable.end());
    zone.insert(zone.end(), g.points.size(), double(g.zone));
  }
  std::vector<mesh::PointField> fields;
  if (operations > 0) fields.push_back({"deviation_um", deviation.back()});
  for (std::size_t n = 0; n < operations; ++n) fields.push_back({"deviation_um_op" + std::to_string(n), deviation[n]});
  fields.push_back({"reachable", reachable});
  fields.push_back({"zone", zone});
  std::ostringstream out;
  if (const auto written = mesh::write_vtp(out, mesh, fields); !written) return written.error();
  return std::move(out).str();
}

}  // namespace toothpath::report
