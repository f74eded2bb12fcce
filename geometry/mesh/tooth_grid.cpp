#include "geometry/mesh/tooth_grid.h"

#include <algorithm>
#include <cmath>

namespace toothpath::mesh {
namespace {

constexpr std::size_t kProbes = 33;
constexpr std::array<std::size_t, kSegmentCount> kLeastCells{1, 3, 2, 1, 2, 3, 1};
constexpr std::size_t kLeastGridRows = 2;

using Lines = std::vector<std::vector<Vec3>>;  // [row][column]

/// Station at parameter u in [0, 1]. Even steps in u crowd at the first end: next to an undercut at s_u the curvature
/// grows like 1/(s - s_u), and its square root is then even in u.
double station_at(const std::array<double, 2>& span, double u) { return span[0] + (span[1] - span[0]) * u * u; }

/// Part of the second difference across the line's own direction, per unit parameter.
double bend(const Vec3& before, const Vec3& at, const Vec3& after) {
  const Vec3 second = before + after - 2 * at, tangent = after - before;
  const double length2 = tangent.squaredNorm();
  const Vec3 across = length2 > 0 ? Vec3(second - tangent * (second.dot(tangent) / length2)) : second;
  return across.norm() * double((kProbes - 1) * (kProbes - 1));
}

/// Nodes in [0, 1] so that every cell has the same share of the integral of sqrt(bend); sag of a cell of width h is
/// bend h^2 / 8.
std::vector<double> equal_shares(const std::vector<double>& bends, double sag_mm, std::size_t least) {
  const std::size_t n = bends.size();
  std::vector<double> density(n), sum(n, 0.0);
  double mean = 0;
  for (std::size_t k = 0; k < n; ++k) {
    density[k] = std::sqrt(bends[k] / (8 * sag_mm));
    mean += density[k] / double(n);
  }
  for (double& d : density) d += 0.05 * mean + 1e-9;  // no cell grows without limit where the surface is straight
  for (std::size_t k = 1; k < n; ++k) sum[k] = sum[k - 1] + 0.5 * (density[k] + density[k - 1]) / double(n - 1);
  const std::size_t cells = std::max(least, std::size_t(std::ceil(sum.back())));
  std::vector<double> nodes(cells + 1, 0.0);
  nodes.back() = 1;
  std::size_t k = 1;
  for (std::size_t c = 1; c < cells; ++c) {
    const double share = sum.back() * double(c) / double(cells);
    while (sum[k] < share) ++k;
    const double t = (share - sum[k - 1]) / (sum[k] - sum[k - 1]);
    nodes[c] = (double(k - 1) + t) / double(n - 1);
  }
  return nodes;
}

}  // namespace

std::size_t ToothGrid::columns() const {
  std::size_t n = 0;
  for (const auto& f : fractions) n += f.size() - 1;
  return n;
}

std::size_t ToothGrid::surface_triangles() const {
  std::size_t rows = 0;
  for (const auto& s : stations) rows += s.size() - 1;
  return 2 * rows * columns();
}

std::vector<GridColumn> grid_columns(const ToothGrid& grid) {
  std::vector<GridColumn> columns;
  std::size_t slot = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s, ++slot)
    for (std::size_t k = 0; k + 1 < grid.fractions[s].size(); ++k, ++slot)
      columns.push_back({s, grid.fractions[s][k], grid.fractions[s][k + 1], slot});
  return columns;
}

Result<GridPlanner> GridPlanner::probe(const tooth_space::ToothedSolid& gear) {
  GridPlanner planner;
  for (auto& b : planner.bend_across_) b.assign(kProbes, 0.0);
  for (const auto& ring : gear.rings) {
    const std::array<double, 2> span{ring.space->outline().s_from, ring.space->outline().s_to};
    planner.span_.push_back(span);
    std::array<Lines, kSegmentCount> lines;
    std::optional<ToothSection> near;
    for (std::size_t i = 0; i < kProbes; ++i) {
      const double s = i + 1 == kProbes ? span[1] : station_at(span, double(i) / double(kProbes - 1));
      auto section = ToothSection::at(*ring.space, s, near ? &*near : nullptr);
      if (!section) return section.error();
      near = *section;
      for (std::size_t segment = 0; segment < kSegmentCount; ++segment) {
        std::vector<Vec3> line;
        for (std::size_t j = 0; j < kProbes; ++j) {
          const auto point = near->point(segment, double(j) / double(kProbes - 1));
          if (!point) return fail("{} is not defined at {}", to_string(segment_patch(segment)), near->station());
          line.push_back(point->p);
        }
        lines[segment].push_back(std::move(line));
      }
    }
    std::vector<double> along(kProbes, 0.0);
    for (std::size_t s = 0; s < kSegmentCount; ++s)
      for (std::size_t i = 0; i < kProbes; ++i)
        for (std::size_t j = 0; j < kProbes; ++j) {
          const auto& l = lines[s];
          const std::size_t jc = std::clamp<std::size_t>(j, 1, kProbes - 2),
                            ic = std::clamp<std::size_t>(i, 1, kProbes - 2);
          auto& across = planner.bend_across_[s][j];
          across = std::max(across, bend(l[i][jc - 1], l[i][jc], l[i][jc + 1]));
          along[i] = std::max(along[i], bend(l[ic - 1][j], l[ic][j], l[ic + 1][j]));
        }
    planner.bend_along_.push_back(std::move(along));
  }
  return planner;
}

ToothGrid GridPlanner::grid(double sag_mm) const {
  ToothGrid grid;
  for (std::size_t s = 0; s < kSegmentCount; ++s)
    grid.fractions[s] = equal_shares(bend_across_[s], sag_mm, kLeastCells[s]);
  for (std::size_t k = 0; k < span_.size(); ++k) {
    std::vector<double> stations = equal_shares(bend_along_[k], sag_mm, kLeastGridRows);
    for (double& u : stations) u = station_at(span_[k], u);
    stations.front() = span_[k][0];
    stations.back() = span_[k][1];
    grid.stations.push_back(std::move(stations));
  }
  return grid;
}

}  // namespace toothpath::mesh
