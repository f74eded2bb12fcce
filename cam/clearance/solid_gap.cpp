#include "cam/clearance/solid_gap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace toothpath::clearance {
namespace {

constexpr double kAnywhere_mm = 1e6;
constexpr std::size_t kScattered = 257;  // every so many vertices first: a near place spares most of the rest

/// Edges of one surface against the facets of the other: the nearest places of two facets that do not meet lie on an
/// edge of one of them, and of two that meet an edge goes through the other.
double edges_to(const mesh::TriangleMesh& edges, const MeshDistance& other, double best) {
  for (std::size_t k = 0; k < edges.vertices.size(); k += kScattered)
    best = std::min(best, other.nearest(edges.vertices[k], best).distance);
  for (const auto& t : edges.triangles)
    for (std::size_t k = 0; k < 3 && best > 0; ++k) {
      if (t[k] > t[(k + 1) % 3]) continue;  // the neighbour has it, too
      const Vec3 &from = edges.vertices[std::size_t(t[k])], &to = edges.vertices[std::size_t(t[(k + 1) % 3])];
      const double length = (to - from).norm();
      if (length > 0) best = std::min(best, other.to_segment(from, (to - from) / length, length, best).distance);
    }
  return best;
}

/// Halves facets until no place of them can reach out farther than what was found.
class FacetSearch {
 public:
  FacetSearch(std::span<const MeshDistance* const> solids, double apart, OutsidePlace found)
      : solids_(solids), apart_(apart), found_(found) {}

  OutsidePlace operator()(const Vec3& a, const Vec3& b, const Vec3& c) {
    visit(a, b, c);
    return found_;
  }

 private:
  void visit(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 middle = (a + b + c) / 3;
    const double reach =
        std::sqrt(std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
    const double out = signed_distance(middle, solids_, reach);
    if (out > found_.out_mm) found_ = {out, middle};
    if (out + reach <= std::max(found_.out_mm, 0.0) + apart_) return;
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (ab >= bc && ab >= ca) halve(a, b, c);
    else if (bc >= ca) halve(b, c, a);
    else halve(c, a, b);
  }
  void halve(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 middle = 0.5 * (a + b);
    visit(a, middle, c);
    visit(middle, b, c);
  }

  std::span<const MeshDistance* const> solids_;
  double apart_;
  OutsidePlace found_;
};

OutsidePlace farthest_of(const std::vector<OutsidePlace>& places) {
  return *std::max_element(places.begin(), places.end(),
                           [](const OutsidePlace& a, const OutsidePlace& b) { return a.out_mm < b.out_mm; });
}

}  // namespace

double surface_gap(const MeasuredMesh& a, const MeasuredMesh& b, double within) {
  return edges_to(b.mesh, a.distance, edges_to(a.mesh, b.distance, within));
}

double signed_distance(const Vec3& p, std::span<const MeshDistance* const> solids, double deep) {
  double least = kAnywhere_mm;
  for (const MeshDistance* solid : solids) {
    const bool inside = solid->inside(p);
    const double distance = solid->nearest(p, inside ? deep : std::max(least, 0.0)).distance;
    least = std::min(least, inside ? -distance : distance);
  }
  return least;
}

OutsidePlace farthest_outside(const mesh::TriangleMesh& surface, const std::vector<bool>& counts,
                              std::span<const MeshDistance* const> solids, double apart_mm) {
  std::vector<OutsidePlace> places(surface.vertices.size() + 1);
  tbb::parallel_for(std::size_t(0), surface.vertices.size(), [&](std::size_t k) {
    if (counts[k]) places[k] = {signed_distance(surface.vertices[k], solids, 0), surface.vertices[k]};
  });
  const OutsidePlace of_corners = farthest_of(places);
  places.assign(surface.triangles.size() + 1, of_corners);
  tbb::parallel_for(std::size_t(0), surface.triangles.size(), [&](std::size_t t) {
    const auto& corners = surface.triangles[t];
    for (const auto k : corners)
      if (!counts[std::size_t(k)]) return;
    places[t] =
        FacetSearch(solids, apart_mm, of_corners)(surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2));
  });
  return farthest_of(places);
}

}  // namespace toothpath::clearance
