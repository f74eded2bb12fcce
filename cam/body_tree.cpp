#include "cam/body_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toothpath {
namespace {

constexpr std::uint32_t kLeaf = 4;  // cells

}  // namespace

BodyTree::BodyTree(const GearDistance& part) : part_(part) {
  for (int z = 0; z < part.zones(); ++z) {
    const auto& cells = part.cells(z);
    Zone zone;
    zone.order.resize(cells.size());
    for (std::uint32_t k = 0; k < zone.order.size(); ++k) zone.order[k] = k;
    if (!cells.empty()) build(zone, cells, 0, std::uint32_t(cells.size()));
    zones_.push_back(std::move(zone));
  }
  const int teeth = part.gear().parameters().teeth;
  for (int k = 0; k < teeth; ++k) {
    const double angle = -2 * std::numbers::pi * k / teeth;
    turns_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

std::uint32_t BodyTree::build(Zone& zone, const std::vector<GearDistance::Cell>& cells, std::uint32_t first, std::uint32_t count) const {
  const auto begin = zone.order.begin() + first, end = begin + count;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (auto k = begin; k != end; ++k) {
    low = low.cwiseMin(cells[*k].centre);
    high = high.cwiseMax(cells[*k].centre);
  }
  Node node;
  node.centre = 0.5 * (low + high);
  for (auto k = begin; k != end; ++k) node.radius = std::max(node.radius, (cells[*k].centre - node.centre).norm() + cells[*k].radius);
  const auto index = std::uint32_t(zone.nodes.size());
  zone.nodes.push_back(node);
  if (count <= kLeaf) {
    zone.nodes[index].first = first;
    zone.nodes[index].count = count;
    return index;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, end, [&](std::uint32_t a, std::uint32_t b) {
    return cells[a].centre[axis] != cells[b].centre[axis] ? cells[a].centre[axis] < cells[b].centre[axis] : a < b;
  });
  const auto left = build(zone, cells, first, count / 2), right = build(zone, cells, first + count / 2, count - count / 2);
  zone.nodes[index].left = left;
  zone.nodes[index].right = right;
  return index;
}

BodyGap BodyTree::gap(const Frustum& body, const Vec3& tip, const Vec3& axis, double enough, double resolution_mm) const {
  BodyGap best{enough, 0, tip};
  const double above = lowest_z(body, tip, axis) - part_.gear().blank_top();
  if (above >= enough) return best;
  const double sag = part_.cell_sag_mm();
  std::vector<std::uint32_t> stack;
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const Zone& zone = zones_[z];
    if (zone.nodes.empty()) continue;
    const auto& cells = part_.cells(int(z));
    const auto& triangles = part_.triangles(int(z));
    for (const auto& [c, s] : turns_) {
      const Vec3 t(c * tip.x() - s * tip.y(), s * tip.x() + c * tip.y(), tip.z());
      const Vec3 u(c * axis.x() - s * axis.y(), s * axis.x() + c * axis.y(), axis.z());
      stack.assign(1, 0);
      while (!stack.empty()) {
        const Node& node = zone.nodes[stack.back()];
        stack.pop_back();
        if (distance_to_frustum(node.centre, body, t, u) - node.radius >= best.gap) continue;
        if (node.count == 0) {
          stack.push_back(node.right);
          stack.push_back(node.left);
          continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
          const auto& cell = cells[zone.order[k]];
          if (distance_to_frustum(cell.centre, body, t, u) - cell.radius >= best.gap) continue;
          double g = best.gap + sag;
          for (std::uint32_t q = cell.first_triangle; q < cell.first_triangle + cell.triangles; ++q)
            g = triangle_gap(triangles[q][0], triangles[q][1], triangles[q][2], body, t, u, g, resolution_mm, 8);
          g -= sag;
          if (g < best.gap) best = {g, int(z), cell.centre};
        }
        if (best.gap <= -resolution_mm) return best;
      }
    }
  }
  best.gap = std::max(best.gap, above);
  return best;
}

bool BodyTree::clear(const std::vector<Frustum>& bodies, const Vec3& tip, const Vec3& axis, double clearance_mm,
                     double resolution_mm) const {
  // A gap below the clearance is looked for only within it: the search ends at the first cell that stands in the way.
  return std::all_of(bodies.begin(), bodies.end(), [&](const Frustum& body) {
    return gap(body, tip, axis, clearance_mm, resolution_mm).gap >= clearance_mm;
  });
}

double BodyTree::depth(const Frustum& body, std::span<const Vec3> tips, const Vec3& axis, double deepest_mm, double resolution_mm) const {
  const auto cuts = [&](double by) {
    Frustum f = body;
    f.from += by;
    f.radius_from = std::max(f.radius_from - by, 0.0);
    f.radius_to = std::max(f.radius_to - by, 0.0);
    return f.from < f.to && std::any_of(tips.begin(), tips.end(), [&](const Vec3& tip) { return gap(f, tip, axis, 0, resolution_mm).gap < 0; });
  };
  double shallow = 0, deep = deepest_mm;
  if (cuts(deep)) return deep;
  while (deep - shallow > resolution_mm) {
    const double middle = 0.5 * (shallow + deep);
    (cuts(middle) ? shallow : deep) = middle;
  }
  return deep;
}

}  // namespace toothpath
