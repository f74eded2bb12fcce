#include "geometry/mesh/solid_check.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh/cgal_check.h"

namespace toothpath::mesh {
namespace {

/// Height over the longest edge, as a part of that edge: below it three corners are on a line but for rounding.
constexpr double kLeastShape = 1e-12;
constexpr double kInch_mm = 25.4;
/// Facets at one edge that are compared for equal corners; where there are more, the edge is refused anyway.
constexpr std::size_t kMostCompared = 16;

struct Edge {
  std::int32_t low = 0, high = 0;
  std::uint32_t facet = 0;
  bool rising = false;  ///< runs from `low` to `high`
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
  });
  return edges;
}

class SolidCheck {
 public:
  SolidCheck(const TriangleMesh& mesh, const std::string& name, const MeshImportLimits& limits)
      : mesh_(mesh), at_{name, 0, 0}, limits_(limits) {}

  Status run() const {
    if (mesh_.triangles.empty()) return fail_at(at_, "the file has 0 facets");
    for (const auto check : {&SolidCheck::coordinates, &SolidCheck::size, &SolidCheck::shapes, &SolidCheck::edges,
                             &SolidCheck::volume, &SolidCheck::crossings})
      if (auto status = (this->*check)(); !status) return status;
    return Ok{};
  }

 private:
  [[nodiscard]] std::string place(std::size_t t) const {
    const Vec3 c = (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3;
    return fmt::format("facet {} near ({:.3f}, {:.3f}, {:.3f})", t, c.x(), c.y(), c.z());
  }

  [[nodiscard]] Status coordinates() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh_.corner(t, k);
        if (!p.allFinite())
          return fail_at(at_, "facet {}: corner {} = ({}, {}, {}) is not finite", t, k, p.x(), p.y(), p.z());
        const double farthest = p.cwiseAbs().maxCoeff();
        if (farthest > limits_.most_coordinate_mm)
          return fail_at(at_, "facet {}: coordinate {:g} mm is farther than {:g} mm from the origin", t, farthest,
                         limits_.most_coordinate_mm);
      }
    return Ok{};
  }

  [[nodiscard]] std::string unit_hint(double size) const {
    const double expected = limits_.expected_size_mm;
    if (!(expected > 0))
      return size < limits_.least_size_mm ? "; is the file in inches or metres?" : "; is the file in micrometres?";
    const auto fits = [&](double unit) { return std::abs(size * unit / expected - 1) < 0.05; };
    if (fits(kInch_mm)) return fmt::format("; {:g} mm is expected, so the file is probably in inches", expected);
    if (fits(1000)) return fmt::format("; {:g} mm is expected, so the file is probably in metres", expected);
    if (fits(0.001)) return fmt::format("; {:g} mm is expected, so the file is probably in micrometres", expected);
    return fmt::format("; {:g} mm is expected", expected);
  }

  [[nodiscard]] Status size() const {
    Vec3 low = mesh_.vertices.front(), high = low;
    for (const Vec3& v : mesh_.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const double size = (high - low).maxCoeff();
    if (size < limits_.least_size_mm)
      return fail_at(at_, "longest side = {:g} mm is below {:g} mm{}", size, limits_.least_size_mm, unit_hint(size));
    if (size > limits_.most_size_mm)
      return fail_at(at_, "longest side = {:g} mm is above {:g} mm{}", size, limits_.most_size_mm, unit_hint(size));
    const double expected = limits_.expected_size_mm;
    if (expected > 0 && (size < 0.1 * expected || size > 10 * expected))
      return fail_at(at_, "longest side = {:g} mm is outside {:g} .. {:g} mm{}", size, 0.1 * expected, 10 * expected,
                     unit_hint(size));
    return Ok{};
  }

  [[nodiscard]] Status shapes() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
      const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      const double shape = longest2 > 0 ? mesh_.area_normal(t).norm() / longest2 : 0.0;
      if (!(shape > kLeastShape))
        return fail_at(at_, "{} is degenerate: its height is {:g} of its longest edge, the limit {:g}", place(t), shape,
                       kLeastShape);
    }
    return Ok{};
  }

  [[nodiscard]] bool same_corners(std::size_t s, std::size_t t) const {
    auto a = mesh_.triangles[s], b = mesh_.triangles[t];
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }

  [[nodiscard]] Status edges() const {
    const std::vector<Edge> edges = sorted_edges(mesh_);
    for (std::size_t k = 0; k < edges.size();) {
      std::size_t end = k;
      while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high) ++end;
      const std::size_t uses = end - k, first = edges[k].facet;
      const std::size_t last = std::min(end, k + kMostCompared);
      for (std::size_t i = k; i < last; ++i)
        for (std::size_t j = i + 1; j < last; ++j)
          if (same_corners(edges[i].facet, edges[j].facet))
            return fail_at(at_, "{} and facet {} have the same three corners", place(edges[i].facet), edges[j].facet);
      if (uses == 1)
        return fail_at(at_, "{} has an open edge: used by 1 facet, a closed surface needs 2", place(first));
      if (uses > 2) return fail_at(at_, "{} has an edge used by {} facets; a solid has 2", place(first), uses);
      if (edges[k].rising == edges[k + 1].rising)
        return fail_at(at_, "{} and facet {} run along their common edge in the same direction: one of them is flipped",
                       place(first), edges[k + 1].facet);
      k = end;
    }
    return Ok{};
  }

  [[nodiscard]] Status volume() const {
    const double v = signed_volume(mesh_);
    if (!(v > 0))
      return fail_at(at_, "enclosed volume = {:g} mm^3 is not above 0: the surface is turned inside out", v);
    return Ok{};
  }

  [[nodiscard]] Status crossings() const {
    if (!limits_.self_intersections) return Ok{};
    const auto check = check_mesh(mesh_, {true, 1});
    if (!check) return fail_at(at_, "{}", check.error().message);
    if (!check->manifold)
      return fail_at(at_, "the surface touches itself at a corner: one corner joins separate fans of facets");
    if (check->self_intersections > 0)
      return fail_at(at_, "{} and facet {} cross each other", place(check->first_intersection[0]),
                     check->first_intersection[1]);
    return Ok{};
  }

  const TriangleMesh& mesh_;
  SourcePosition at_;
  const MeshImportLimits& limits_;
};

}  // namespace

Status check_solid(const TriangleMesh& mesh, const std::string& name, const MeshImportLimits& limits) {
  return SolidCheck(mesh, name, limits).run();
}

}  // namespace toothpath::mesh
