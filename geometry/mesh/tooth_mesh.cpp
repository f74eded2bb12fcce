#include "geometry/mesh/tooth_mesh.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/mesh/pitch_builder.h"

namespace toothpath::mesh {
namespace {

constexpr double kLeastTolerance_mm = 1e-4, kMostTolerance_mm = 10;
constexpr std::size_t kMostPitchTriangles = 1'000'000, kMostGearTriangles = 40'000'000;
constexpr int kMostRefinements = 40;  // on coarse grids many steps of the aim change no cell

using Index = std::int32_t;
constexpr std::size_t idx(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

double ToothMesh::max_sag() const { return *std::max_element(max_sag_mm.begin(), max_sag_mm.end()); }

Vec3 ToothMesh::vertex_of_copy(std::size_t index, int k) const {
  const Index from = turned_from[index];
  if (std::size_t(from) == index) return mesh.vertices[index];
  return from < 0 ? turned_by_pitches(mesh.vertices[index], k, teeth)
                  : turned_by_pitches(mesh.vertices[idx(from)], k + 1, teeth);
}

Vec3 turned_by_pitches(const Vec3& p, int k, int teeth) {
  const int reduced = ((k % teeth) + teeth) % teeth;
  if (reduced == 0) return p;
  const double angle = 2 * kPi * reduced / teeth;
  return turned(p, angle);
}

Result<ToothMesh> mesh_tooth_space(const ToothedSolid& gear, double tolerance_mm) {
  if (!(tolerance_mm >= kLeastTolerance_mm && tolerance_mm <= kMostTolerance_mm))
    return fail("mesh tolerance = {:g} mm is outside {:g} .. {:g} mm", tolerance_mm, kLeastTolerance_mm,
                kMostTolerance_mm);
  const auto planner = GridPlanner::probe(gear);
  if (!planner) return planner.error();
  double aim = 0.45 * tolerance_mm;  // two directions share the sag
  double worst = 0;
  for (int k = 0; k < kMostRefinements; ++k) {
    const ToothGrid grid = planner->grid(aim);
    if (grid.surface_triangles() > kMostPitchTriangles)
      return fail("mesh tolerance = {:g} mm needs {} triangles in one pitch; the limit is {}", tolerance_mm,
                  grid.surface_triangles(), kMostPitchTriangles);
    PitchBuilder builder(gear, grid, tolerance_mm);
    if (const auto built = builder.build(); !built) return built.error();
    for (const int samples : {2, 4}) {  // a coarse look first
      const auto sag = builder.measure_sag(samples);
      if (!sag) return sag.error();
      worst = *std::max_element(sag->begin(), sag->end());
      if (worst > tolerance_mm) break;
      if (samples == 4) {
        ToothMesh mesh = builder.take();
        mesh.max_sag_mm = *sag;
        return mesh;
      }
    }
    aim *= std::clamp(0.95 * tolerance_mm / worst, 0.1, 0.95);
  }
  return fail("mesh tolerance = {:g} mm is not reached: the facets still sag by {:g} mm", tolerance_mm, worst);
}

Result<TriangleMesh> mesh_gear(const ToothedSolid& gear, double tolerance_mm) {
  const auto pitch = mesh_tooth_space(gear, tolerance_mm);
  if (!pitch) return pitch.error();
  const std::size_t triangles = pitch->mesh.triangles.size() * std::size_t(pitch->teeth);
  if (triangles > kMostGearTriangles)
    return fail("mesh tolerance = {:g} mm needs {} triangles for the gear; the limit is {}", tolerance_mm, triangles,
                kMostGearTriangles);
  return join_copies(*pitch);
}

TriangleMesh join_copies(const ToothMesh& pitch) {
  std::vector<Index> own(pitch.mesh.vertices.size(), -1);
  Index count = 0, on_axis = 0;
  for (std::size_t v = 0; v < own.size(); ++v) {
    if (pitch.turned_from[v] < 0) own[v] = count++;
    if (std::size_t(pitch.turned_from[v]) == v) own[v] = on_axis++;
  }
  TriangleMesh gear;
  gear.vertices.reserve(std::size_t(count) * std::size_t(pitch.teeth));
  gear.triangles.reserve(pitch.mesh.triangles.size() * std::size_t(pitch.teeth));
  for (int k = 0; k < pitch.teeth; ++k) {
    for (std::size_t v = 0; v < own.size(); ++v)
      if (pitch.turned_from[v] < 0) gear.vertices.push_back(pitch.vertex_of_copy(v, k));
    const auto joined = [&](Index v) {
      const Index from = pitch.turned_from[idx(v)];
      if (from == v) return pitch.teeth * count + own[idx(v)];
      return from < 0 ? k * count + own[idx(v)] : ((k + 1) % pitch.teeth) * count + own[idx(from)];
    };
    for (const auto& t : pitch.mesh.triangles) gear.triangles.push_back({joined(t[0]), joined(t[1]), joined(t[2])});
  }
  for (std::size_t v = 0; v < own.size(); ++v)
    if (std::size_t(pitch.turned_from[v]) == v) gear.vertices.push_back(pitch.mesh.vertices[v]);
  return gear;
}

std::vector<double> patch_of_vertices(const ToothMesh& pitch) {
  std::vector<double> field(pitch.mesh.vertices.size(), double(tooth_space::kSurfaces));
  for (std::size_t t = pitch.tags.size(); t-- > 0;)
    for (const auto vertex : pitch.mesh.triangles[t]) field[idx(vertex)] = double(pitch.tags[t].patch);
  return field;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3 centre = mesh.vertices.front();
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += (mesh.corner(t, 0) - centre).dot((mesh.corner(t, 1) - centre).cross(mesh.corner(t, 2) - centre));
  return sum / 6;
}

std::optional<tooth_space::PatchPoint> exact_patch_point(const ToothedSolid& gear, int ring, Piece patch,
                                                         const Vec2& uv) {
  const auto& space = *gear.rings[std::size_t(ring)].space;
  if (int(patch) < tooth_space::kPieces) return space.point(patch, uv.x(), uv.y());
  if (patch != Piece::tip) return {};
  const auto& chart = space.outline().chart;
  const double s = uv.y(), h = space.tip(s), slope = space.tip_bend(s, s).slope.middle(), r = chart.r(s, h);
  const Vec3 outwards(std::cos(uv.x()), std::sin(uv.x()), 0);
  tooth_space::PatchPoint at;
  at.p = r * outwards + chart.z(s, h) * Vec3::UnitZ();
  // Across the meridian's way (1, slope) in (s, h).
  at.n = (chart.r(-slope, 1) * outwards + chart.z(-slope, 1) * Vec3::UnitZ()).normalized();
  return at;
}

}  // namespace toothpath::mesh
