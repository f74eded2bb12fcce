#include "geometry/mesh/cgal_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include "geometry/mesh/facets_apart.h"

namespace toothpath::mesh {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Soup = std::vector<std::array<std::size_t, 3>>;

/// Ends the look at pairs.
struct Enough {};

/// Are facets joined by edges alone: every directed edge in one facet, every corner with one fan of them?
class Fans {
 public:
  Fans(std::size_t points, const Soup& soup) : first_(points + 1, 0), soup_(soup) {
    for (const auto& facet : soup)
      for (const std::size_t corner : facet) ++first_[corner + 1];
    for (std::size_t p = 0; p < points; ++p) first_[p + 1] += first_[p];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    edges_.resize(3 * soup.size());
    for (std::size_t edge = 0; edge < edges_.size(); ++edge) edges_[next[from(edge)]++] = edge;
    for (std::size_t p = 0; p < points; ++p)
      std::sort(begin(p), end(p), [&](std::size_t a, std::size_t b) { return to(a) < to(b); });
  }
  [[nodiscard]] bool manifold() const {
    for (const auto& [a, b, c] : soup_)
      if (a == b || b == c || c == a) return false;
    for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
      const auto same = [&](std::size_t a, std::size_t b) { return to(a) == to(b); };
      if (std::adjacent_find(begin(p), end(p), same) != end(p)) return false;
    }
    for (std::size_t p = 0; p + 1 < first_.size(); ++p)
      if (begin(p) != end(p) && !one_fan(p)) return false;
    return true;
  }

 private:
  using Edges = std::vector<std::size_t>;  ///< edge 3 t + k runs from corner k of facet t to the next one
  static std::size_t behind(std::size_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
  static std::size_t ahead(std::size_t edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }
  [[nodiscard]] std::size_t from(std::size_t edge) const { return soup_[edge / 3][edge % 3]; }
  [[nodiscard]] std::size_t to(std::size_t edge) const { return from(behind(edge)); }
  [[nodiscard]] Edges::iterator begin(std::size_t p) { return edges_.begin() + std::ptrdiff_t(first_[p]); }
  [[nodiscard]] Edges::iterator end(std::size_t p) { return edges_.begin() + std::ptrdiff_t(first_[p + 1]); }
  [[nodiscard]] Edges::const_iterator begin(std::size_t p) const { return edges_.begin() + std::ptrdiff_t(first_[p]); }
  [[nodiscard]] Edges::const_iterator end(std::size_t p) const {
    return edges_.begin() + std::ptrdiff_t(first_[p + 1]);
  }
  [[nodiscard]] std::optional<std::size_t> opposite(std::size_t edge) const {
    const std::size_t p = to(edge), q = from(edge);
    const auto found = std::lower_bound(begin(p), end(p), q, [&](std::size_t e, std::size_t v) { return to(e) < v; });
    return found != end(p) && to(*found) == q ? std::optional(*found) : std::nullopt;
  }
  /// From one facet at the corner to all others there, first to one side, then to the other.
  [[nodiscard]] bool one_fan(std::size_t p) const {
    const std::size_t start = *begin(p);
    std::size_t met = 1;
    std::optional<std::size_t> edge = opposite(ahead(start));
    for (; edge && *edge != start; edge = opposite(ahead(*edge))) ++met;
    if (!edge)
      for (edge = opposite(start); edge; edge = opposite(behind(*edge))) ++met;
    return met == first_[p + 1] - first_[p];
  }

  std::vector<std::size_t> first_;  ///< of the edges that leave each point
  const Soup& soup_;
  Edges edges_;  ///< point by point, there by where they lead
};

/// Do any two facets at one corner make more than `most` pairs?
bool more_at_a_corner(std::size_t most, std::size_t points, const Soup& soup) {
  std::vector<std::size_t> fan(points, 0);
  for (const auto& triangle : soup)
    for (const std::size_t corner : triangle)
      if (const std::size_t n = ++fan[corner]; n * (n - 1) / 2 > most) return true;
  return false;
}

/// Do two facets of a manifold mesh cross? CGAL looks through every facet of the mesh that it is asked of, so it gets
/// one of these two alone, joined as they are.
bool cross(const std::vector<Vec3>& points, const Soup::value_type& a, const Soup::value_type& b) {
  SurfaceMesh two;
  std::array<SurfaceMesh::Vertex_index, 3> of_a, of_b;
  const auto added = [&](std::size_t p) {
    return two.add_vertex(Kernel::Point_3(points[p].x(), points[p].y(), points[p].z()));
  };
  std::transform(a.begin(), a.end(), of_a.begin(), added);
  std::transform(b.begin(), b.end(), of_b.begin(), [&](std::size_t p) {
    const auto same = std::find(a.begin(), a.end(), p);
    return same == a.end() ? added(p) : of_a[std::size_t(same - a.begin())];
  });
  const std::array both{two.add_face(of_a), two.add_face(of_b)};
  return pmp::does_self_intersect(both, two);
}

/// Looks at all pairs of facets whose boxes meet; are there more than `most`? The exact question is asked of those that
/// are not surely apart.
bool more_pairs_than(std::size_t most, const std::vector<Vec3>& points, const Soup& soup, std::size_t most_crossing,
                     MeshCheck& check) {
  if (more_at_a_corner(most, points.size(), soup)) return true;
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  std::vector<Box> boxes;
  boxes.reserve(soup.size());
  for (std::size_t t = 0; t < soup.size(); ++t) {
    const Vec3 &a = points[soup[t][0]], &b = points[soup[t][1]], &c = points[soup[t][2]];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    boxes.emplace_back(CGAL::Bbox_3(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()), std::uint32_t(t));
  }
  std::size_t pairs = 0;
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
      if (++pairs > most) throw Enough{};
      const std::uint32_t s = a.info(), t = b.info();
      if (!check.manifold || check.self_intersections >= most_crossing || surely_apart(points, soup[s], soup[t]))
        return;
      if (cross(points, soup[s], soup[t]) && check.self_intersections++ == 0) check.first_intersection = {s, t};
    });
  } catch (const Enough&) { return true; }
  return false;
}

/// Pairs allowed where there are more of them, else 0.
std::size_t check_soup(const std::vector<Vec3>& points, const Soup& soup, const MeshCheckOptions& options,
                       MeshCheck& check) {
  SurfaceMesh mesh;
  check.manifold = Fans(points.size(), soup).manifold();
  if (check.manifold) {
    std::vector<Kernel::Point_3> exact;
    exact.reserve(points.size());
    for (const Vec3& p : points) exact.emplace_back(p.x(), p.y(), p.z());
    pmp::polygon_soup_to_polygon_mesh(exact, soup, mesh);
    check.closed = CGAL::is_closed(mesh);
    auto component = mesh.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:component", 0).first;
    check.components = pmp::connected_components(mesh, component);
    if (check.closed) {
      check.volume_mm3 = CGAL::to_double(pmp::volume(mesh));
      // Several pieces: one piece inside another may well be a cavity, so only the sum counts.
      check.outward = check.components == 1 ? pmp::is_outward_oriented(mesh) : check.volume_mm3 > 0;
    }
  }
  if (!options.self_intersections) return 0;
  const std::size_t most = std::max(options.most_compared, options.most_compared_each * soup.size());
  return more_pairs_than(most, points, soup, options.most_pairs, check) ? most : 0;
}

}  // namespace

Result<MeshCheck> check_mesh(const TriangleMesh& mesh, const MeshCheckOptions& options) {
  if (mesh.triangles.empty()) return fail("the mesh has no triangle");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (!p.allFinite()) return fail("vertex {} = ({}, {}, {}) is not finite", v, p.x(), p.y(), p.z());
  }
  Soup soup;
  soup.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const auto v : mesh.triangles[t])
      if (v < 0 || std::size_t(v) >= mesh.vertices.size())
        return fail("triangle {} has corner index {}; the mesh has {} vertices", t, v, mesh.vertices.size());
    soup.push_back(
        {std::size_t(mesh.triangles[t][0]), std::size_t(mesh.triangles[t][1]), std::size_t(mesh.triangles[t][2])});
  }
  MeshCheck check;
  std::size_t too_many = 0;
  try {
    too_many = check_soup(mesh.vertices, soup, options, check);
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
