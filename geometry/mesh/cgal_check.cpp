#include "geometry/mesh/cgal_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <exception>

namespace toothpath::mesh {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Soup = std::vector<std::array<std::size_t, 3>>;

/// Takes the pairs that CGAL reports and stops at a limit by throwing.
struct Enough {};
struct PairCounter {
  using iterator_category = std::output_iterator_tag;
  using value_type = void;
  using difference_type = void;
  using pointer = void;
  using reference = void;
  MeshCheck* check;
  std::size_t most;
  PairCounter& operator*() { return *this; }
  PairCounter& operator++() { return *this; }
  PairCounter& operator++(int) { return *this; }
  template <typename Pair>
  PairCounter& operator=(const Pair& pair) {
    if (check->self_intersections++ == 0)
      check->first_intersection = {std::size_t(pair.first), std::size_t(pair.second)};
    if (check->self_intersections >= most) throw Enough{};
    return *this;
  }
};

/// Do more than `most` pairs of triangles have boxes that meet?
bool more_pairs_than(std::size_t most, const std::vector<Kernel::Point_3>& points, const Soup& soup) {
  std::vector<std::size_t> fan(points.size(), 0);  // facets at a corner: every two of them are such a pair
  for (const auto& triangle : soup)
    for (const std::size_t corner : triangle)
      if (const std::size_t n = ++fan[corner]; n * (n - 1) / 2 > most) return true;
  using Box = CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_EXPLICIT>;
  std::vector<Box> boxes;
  boxes.reserve(soup.size());
  for (const auto& [a, b, c] : soup) boxes.emplace_back(points[a].bbox() + points[b].bbox() + points[c].bbox());
  std::size_t pairs = 0;
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box&, const Box&) {
      if (++pairs > most) throw Enough{};
    });
  } catch (const Enough&) { return true; }
  return false;
}

/// Pairs allowed where there are more of them, else 0.
std::size_t check_soup(const std::vector<Kernel::Point_3>& points, const Soup& soup, const MeshCheckOptions& options,
                       MeshCheck& check) {
  if (options.self_intersections) {
    const std::size_t most = std::max(options.most_compared, options.most_compared_each * soup.size());
    if (more_pairs_than(most, points, soup)) return most;
  }
  SurfaceMesh mesh;
  check.manifold = pmp::is_polygon_soup_a_polygon_mesh(soup);
  if (check.manifold) {
    pmp::polygon_soup_to_polygon_mesh(points, soup, mesh);
    check.closed = CGAL::is_closed(mesh);
    auto component = mesh.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:component", 0).first;
    check.components = pmp::connected_components(mesh, component);
    if (check.closed) {
      check.volume_mm3 = CGAL::to_double(pmp::volume(mesh));
      // Several pieces: one piece inside another may well be a cavity, so only the sum counts.
      check.outward = check.components == 1 ? pmp::is_outward_oriented(mesh) : check.volume_mm3 > 0;
    }
  }
  if (!options.self_intersections || !check.manifold) return 0;
  try {
    pmp::self_intersections(mesh, PairCounter{&check, options.most_pairs});
  } catch (const Enough&) { return 0; }
  return 0;
}

}  // namespace

Result<MeshCheck> check_mesh(const TriangleMesh& mesh, const MeshCheckOptions& options) {
  if (mesh.triangles.empty()) return fail("the mesh has no triangle");
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (!p.allFinite()) return fail("vertex {} = ({}, {}, {}) is not finite", v, p.x(), p.y(), p.z());
    points.emplace_back(p.x(), p.y(), p.z());
  }
  Soup soup;
  soup.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const auto v : mesh.triangles[t])
      if (v < 0 || std::size_t(v) >= points.size())
        return fail("triangle {} has corner index {}; the mesh has {} vertices", t, v, points.size());
    soup.push_back(
        {std::size_t(mesh.triangles[t][0]), std::size_t(mesh.triangles[t][1]), std::size_t(mesh.triangles[t][2])});
  }
  MeshCheck check;
  std::size_t too_many = 0;
  try {
    too_many = check_soup(points, soup, options, check);
  } catch (const std::exception& problem) { return fail("the mesh could not be examined: {}", problem.what()); }
  if (too_many > 0)
    return fail(
        "the boxes around its {} facets meet in more than {} pairs: too many long thin facets to compare them all; a "
        "mesh "
        "with more even facets is needed",
        soup.size(), too_many);
  return check;
}

}  // namespace toothpath::mesh
