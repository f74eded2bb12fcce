#include "cam/analytic/body_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cam/tool/frustum_distance.h"

namespace toothpath::analytic {
namespace {

constexpr std::uint32_t kLeaf = 4;  // cells
constexpr int kHalvings = 8;        // of a facet, at most
constexpr double kTreeRoundOff =
    1e-11;  // mm: bounds of a branch and of what lies in it may disagree by less; so no order of search matters

Vec3 turned_by(const Vec3& p, const std::pair<double, double>& turn) {
  return {turn.first * p.x() - turn.second * p.y(), turn.second * p.x() + turn.first * p.y(), p.z()};
}

}  // namespace

/// One body at one place. `best_` is counted to the facets; the surface may stand `sag` above them.
class BodyTree::Search {
 public:
  /// @param stop the search may end where the gap is found to be less
  /// @param left_out  zone that is not asked; -1: all are
  Search(const BodyTree& tree, const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double enough, double stop,
         double resolution_mm, int left_out)
      : tree_(tree),
        left_out_(left_out),
        body_(body),
        tip_(tip),
        axis_(axis),
        enough_(enough),
        best_(enough + tree.sag_),
        stop_(std::max(stop, 0.0) + tree.sag_),
        resolution_(resolution_mm),
        middle_(tip + 0.5 * (body.from + body.to) * axis),
        radius_(std::hypot(0.5 * (body.to - body.from), std::max(body.radius_from, body.radius_to))) {}

  double run() {
    for (std::size_t z = 0; z < tree_.zones_.size() && !ended(); ++z)
      if (const Zone& zone = tree_.zones_[z]; int(z) != left_out_ && !zone.nodes.empty()) teeth(zone);
    return best_ < enough_ + tree_.sag_ ? best_ - tree_.sag_ : enough_;  // (enough + sag) - sag may be less than enough
  }

 private:
  [[nodiscard]] bool ended() const { return best_ < stop_; }

  /// The teeth whose sphere comes near that of the body, nearest first.
  void teeth(const Zone& zone) {
    const Node& root = zone.nodes.front();
    const double reach = best_ + root.radius + radius_ + kTreeRoundOff, dz = middle_.z() - root.centre.z();
    const double ra = std::hypot(middle_.x(), middle_.y()), rb = std::hypot(root.centre.x(), root.centre.y()),
                 pitch = tree_.pitch_;
    if (std::hypot(ra - rb, dz) > reach) return;
    const int count = int(tree_.turns_.size());
    const double away = std::atan2(middle_.y(), middle_.x()) - std::atan2(root.centre.y(), root.centre.x());
    const int nearest = int(std::lround(away / pitch));
    const double cosine = (ra * ra + rb * rb + dz * dz - reach * reach) / std::max(2 * ra * rb, 1e-300);
    const int wide = cosine <= -1 ? count : std::min(count, 1 + int(std::acos(std::min(cosine, 1.0)) / pitch));
    for (int k = 0; k <= 2 * wide && k < count && !ended(); ++k) {
      const int tooth = nearest + (k % 2 == 0 ? k / 2 : -(k + 1) / 2);
      const auto& turn = tree_.turns_[std::size_t(((tooth % count) + count) % count)];
      descend(zone, tool::PlacedFrustum(body_, turned_by(tip_, turn), turned_by(axis_, turn)));
    }
  }

  void descend(const Zone& zone, const tool::PlacedFrustum& body) {
    struct Open {
      std::uint32_t node;
      double least;
    };
    std::array<Open, 64> open;  // each step down the halved tree leaves one behind
    std::size_t count = 0;
    const auto enter = [&](std::uint32_t index) -> Open {
      const Node& node = zone.nodes[index];
      if (body.beyond(node.centre, best_ + node.radius + kTreeRoundOff)) return {index, INFINITY};
      return {index, body.distance(node.centre) - node.radius};
    };
    open[count++] = enter(0);
    while (count > 0 && !ended()) {
      const Open at = open[--count];
      if (at.least > best_ + kTreeRoundOff) continue;
      const Node& node = zone.nodes[at.node];
      if (node.count > 0) {
        leaf(zone, node, body);
        continue;
      }
      Open near = enter(node.left), far = enter(node.right);
      if (far.least < near.least) std::swap(near, far);
      open[count++] = far;
      open[count++] = near;
    }
  }

  void leaf(const Zone& zone, const Node& node, const tool::PlacedFrustum& body) {
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Cell& cell = zone.cells[k];
      if (body.beyond(cell.centre, best_ + cell.radius + kTreeRoundOff)) continue;
      for (std::uint32_t q = cell.first; q < cell.first + cell.count && !ended(); ++q) {
        const Facet& f = zone.facets[q];
        facet(f.corner[0], f.corner[1], f.corner[2], f.centre, f.size, body, kHalvings);
      }
    }
  }

  /// A facet is halved until its size is `resolution` or can matter no more; it stands for the sphere about it.
  void facet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& centre, double size,
             const tool::PlacedFrustum& body, int depth) {
    if (ended() || body.beyond(centre, best_ + size + kTreeRoundOff)) return;
    const double distance = body.distance(centre);
    if (distance - size > best_ + kTreeRoundOff) return;
    if (distance <= 0 || size <= resolution_ || depth == 0) {
      best_ = std::min(best_, distance <= 0 ? -resolution_ : distance - size);
      return;
    }
    // The distance is convex: no place of the facet lies below the tangent plane at its middle, no sphere of a piece
    // reaches farther down.
    double last = size;
    for (int k = depth; k > 0 && last > resolution_; --k) last *= 0.5;
    const Vec3 slope = body.slope(centre).gradient;
    const double lowest = distance + std::min({slope.dot(a - centre), slope.dot(b - centre), slope.dot(c - centre)});
    if (lowest - last > best_ + kTreeRoundOff) return;
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const auto part = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
      facet(p, q, r, (p + q + r) / 3, 0.5 * size, body, depth - 1);
    };
    part(ab, bc, ca);
    part(a, ab, ca);
    part(ab, b, bc);
    part(ca, bc, c);
  }

  const BodyTree& tree_;
  int left_out_;
  const tool::Frustum& body_;
  Vec3 tip_, axis_;
  double enough_, best_, stop_, resolution_;
  Vec3 middle_;
  double radius_;
};

BodyTree::BodyTree(const GearDistance& part)
    : roof_(part.part()), sag_(part.cell_sag_mm()), pitch_(part.part().pitch()) {
  for (int z = 0; z < part.zones(); ++z) {
    Zone zone;
    const auto& triangles = part.triangles(z);
    for (const auto& [a, b, c] : triangles) {
      const Vec3 centre = (a + b + c) / 3;
      zone.facets.push_back(
          {{a, b, c}, centre, std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()})});
    }
    for (const auto& cell : part.cells(z)) {
      if (cell.triangles == 0) continue;
      Cell own{cell.centre, 0, cell.first_triangle, cell.triangles};
      for (std::uint32_t q = own.first; q < own.first + own.count; ++q)
        for (const Vec3& p : triangles[q]) own.radius = std::max(own.radius, (p - own.centre).norm());
      zone.cells.push_back(own);
    }
    if (!zone.cells.empty()) build(zone, 0, std::uint32_t(zone.cells.size()));
    zones_.push_back(std::move(zone));
  }
  const int teeth = part.part().teeth();
  for (int k = 0; k < teeth; ++k) {
    const double angle = -2 * std::numbers::pi * k / teeth;
    turns_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

std::uint32_t BodyTree::build(Zone& zone, std::uint32_t first, std::uint32_t count) {
  const auto begin = zone.cells.begin() + first, end = begin + count;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (auto k = begin; k != end; ++k) {
    low = low.cwiseMin(k->centre);
    high = high.cwiseMax(k->centre);
  }
  Node node;
  node.centre = 0.5 * (low + high);
  for (auto k = begin; k != end; ++k) node.radius = std::max(node.radius, (k->centre - node.centre).norm() + k->radius);
  const auto index = std::uint32_t(zone.nodes.size());
  zone.nodes.push_back(node);
  if (count <= kLeaf) {
    zone.nodes[index].first = first;
    zone.nodes[index].count = count;
    return index;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, end, [&](const Cell& a, const Cell& b) {
    return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.first < b.first;
  });
  const auto left = build(zone, first, count / 2), right = build(zone, first + count / 2, count - count / 2);
  zone.nodes[index].left = left;
  zone.nodes[index].right = right;
  return index;
}

double BodyTree::least(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double enough, double stop,
                       double resolution_mm, int left_out) const {
  const double above = roof_.over(body, tip, axis);
  if (above >= enough) return enough;
  const double found = Search(*this, body, tip, axis, enough, stop, resolution_mm, left_out).run();
  return std::max(found, above);  // the whole part lies below: that is a proven gap too
}

double BodyTree::gap(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double enough,
                     double resolution_mm) const {
  const double found = least(body, tip, axis, enough, 0, resolution_mm);
  return found < 0 ? -resolution_mm : found;
}

bool BodyTree::keeps(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, double clearance_mm,
                     double resolution_mm) const {
  return least(body, tip, axis, clearance_mm, clearance_mm, resolution_mm) >= clearance_mm;
}

bool BodyTree::keeps_other_rings(int zone, const tool::Frustum& body, const Vec3& tip, const Vec3& axis,
                                 double clearance_mm, double resolution_mm) const {
  return least(body, tip, axis, clearance_mm, clearance_mm, resolution_mm, zone) >= clearance_mm;
}

bool BodyTree::clear(const std::vector<tool::Frustum>& bodies, const Vec3& tip, const Vec3& axis, double clearance_mm,
                     double resolution_mm) const {
  return std::all_of(bodies.begin(), bodies.end(),
                     [&](const tool::Frustum& body) { return keeps(body, tip, axis, clearance_mm, resolution_mm); });
}

double BodyTree::depth(const tool::Frustum& body, std::span<const Vec3> tips, const Vec3& axis, double deepest_mm,
                       double resolution_mm) const {
  int steps = 1;  // a power of two
  while (deepest_mm / steps > resolution_mm) steps *= 2;
  const auto cuts = [&](int step, const Vec3& tip) {
    const double by = deepest_mm * step / steps;
    tool::Frustum f = body;
    f.from += by;
    f.radius_from = std::max(f.radius_from - by, 0.0);
    f.radius_to = std::max(f.radius_to - by, 0.0);
    return f.from < f.to && !keeps(f, tip, axis, 0, resolution_mm);
  };
  // Most tips ask one question: are they free where the others are?
  int free = 1;
  std::vector<char> open(tips.size(), 1);
  while (true) {
    tbb::parallel_for(std::size_t(0), tips.size(), [&](std::size_t k) { open[k] = open[k] && cuts(free, tips[k]); });
    const auto first = std::find(open.begin(), open.end(), 1);
    if (first == open.end()) break;
    const Vec3& tip = tips[std::size_t(first - open.begin())];
    int shallow = free, deep = steps;
    if (cuts(deep, tip)) return deepest_mm;
    while (deep - shallow > 1) {
      const int middle = (shallow + deep) / 2;
      (cuts(middle, tip) ? shallow : deep) = middle;
    }
    free = deep;
    *first = 0;
  }
  return deepest_mm * free / steps;
}

}  // namespace toothpath::analytic
