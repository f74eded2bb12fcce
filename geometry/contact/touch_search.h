// The first touch of one flank with its pinion at one position of the gear: where on the flank, at which turn of the
// pinion. Inside of tooth_contact.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geometry/contact/nearest_turn.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::contact {

/// A turn about the gear's axis; sine and cosine once for many places.
struct GearTurn {
  double c, s;
  explicit GearTurn(double angle) : c(std::cos(angle)), s(std::sin(angle)) {}
  Vec3 operator()(const Vec3& v) const { return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()}; }
};

/// The pinion's turn, times the side, that a place of the gear asks for; never where the pinion has no involute.
/// @param field  of the pinion; null: plain
inline double asked_turn(const Pinion<double>& pinion, const modification::Field* field, int side, const Vec3& point) {
  const auto place = pinion.place(point);
  if (!(place.radius >= pinion.r_b) || !(place.radius <= pinion.r_a)) return kNever;
  const double plain = side * pinion.turn_at(side, place);
  // Parallel involute helicoids are turned copies.
  return field == nullptr ? plain : plain - set_back(pinion, *field, side, place) / (pinion.r_b * pinion.cos_bb);
}

template <typename F>
double golden_place(F&& f, double lo, double hi) {
  constexpr double kRatio = 0.6180339887498949;
  double a = lo, b = hi, c = b - kRatio * (b - a), d = a + kRatio * (b - a), fc = f(c), fd = f(d);
  for (int k = 0; k < 32; ++k) {
    if (fc > fd) {
      b = d, d = c, fd = fc;
      c = b - kRatio * (b - a), fc = f(c);
    } else {
      a = c, c = d, fc = fd;
      d = a + kRatio * (b - a), fd = f(d);
    }
  }
  const double m = (a + b) / 2, fm = f(m), flo = f(lo), fhi = f(hi);
  if (flo > fm && flo >= fhi) return lo;
  return fhi > fm ? hi : m;
}

/// The search for the first touch on one flank at one position of the gear: the highest asked turn over the grid and
/// between its nodes.
class TouchSearch {
 public:
  TouchSearch(const ContactMember& member, double phi_2)
      : flank_(member.flank),
        pinion_(member.pinion),
        on_pinion_(member.on_pinion.get()),
        turn_(phi_2),
        exact_(member.flank.exact()) {
    nodes_.resize(flank_.points.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      nodes_[k] = asked_turn(pinion_, on_pinion_, flank_.side,
                             turn_(flank_.points[k] + flank_.deviation_mm[k] * flank_.normals[k]));
      if (nodes_[k] > kNever) any_ = true;
    }
  }

  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] const std::vector<double>& nodes() const { return nodes_; }

  /// Best place between the nodes.
  [[nodiscard]] std::optional<TouchPlace> best() const {
    if (!any_) return std::nullopt;
    int best_column = -1;
    double best_value = kNever;
    for (int c = 0; c < flank_.columns; ++c) {
      const double value = estimate(c);
      if (value > best_value) best_value = value, best_column = c;
    }
    if (best_column < 0) return std::nullopt;
    const auto along = [&](double column) { return value_at(row_of(column, true), column); };
    // The bracket moves on while the best place lies at its end: neighbouring columns differ by less than their
    // estimates may err.
    double column = best_column;
    for (int k = 0; k < flank_.columns; ++k) {
      const double from = std::max(0.0, std::floor(column) - 1),
                   to = std::min(flank_.columns - 1.0, std::ceil(column) + 1);
      const double next = golden_place(along, from, to);
      const bool at_end = (next == from && from > 0) || (next == to && to < flank_.columns - 1);
      column = next;
      if (!at_end) break;
    }
    TouchPlace place;
    place.column = column;
    place.row = row_of(column, true);
    place.point = point_at(place.row, column);
    place.phi_1 = flank_.side * value_at(place.row, column);
    return place;
  }

 private:
  struct Cell {
    std::size_t k00, k01, k10, k11;
    double u, v;
  };
  [[nodiscard]] Cell cell(double row, double column) const {
    const int r = std::clamp(static_cast<int>(row), 0, flank_.rows - 2),
              c = std::clamp(static_cast<int>(column), 0, flank_.columns - 2);
    const std::size_t k = flank_.index(r, c), w = static_cast<std::size_t>(flank_.columns);
    return {k, k + 1, k + w, k + w + 1, row - r, column - c};
  }
  template <typename Field>
  static double blend(const Field& f, const Cell& c) {
    return (1 - c.u) * ((1 - c.v) * f[c.k00] + c.v * f[c.k01]) + c.u * ((1 - c.v) * f[c.k10] + c.v * f[c.k11]);
  }
  /// Parameters are blended, so the point lies on the exact flank; its deviation is blended too.
  [[nodiscard]] Vec3 point_at(double row, double column) const {
    const Cell c = cell(row, column);
    const auto p = flank_.at(blend(flank_.theta, c), blend(flank_.B, c));
    return exact_ ? p.p : Vec3(p.p + blend(flank_.deviation_mm, c) * p.n);
  }
  [[nodiscard]] double value_at(double row, double column) const {
    return row < 0 ? kNever : asked_turn(pinion_, on_pinion_, flank_.side, turn_(point_at(row, column)));
  }
  /// Highest asked turn of a node column: the parabola through the best node and its neighbours, or the edge of the
  /// pinion's involute.
  [[nodiscard]] double estimate(int c) const {
    const double row = row_of(c, false);
    if (row < 0) return kNever;
    const double value = value_at(row, c);
    const int r = static_cast<int>(row);
    if (row != r || r == 0 || r + 1 >= flank_.rows) return value;
    const double below = nodes_[flank_.index(r - 1, c)], above = nodes_[flank_.index(r + 1, c)];
    if (below == kNever || above == kNever) return value;
    const double bend = 2 * value - below - above;
    return bend > 0 ? value + (above - below) * (above - below) / (8 * bend) : value;
  }
  /// The best row of a column; with `refine` between the nodes. -1: none is within the pinion's involute.
  [[nodiscard]] double row_of(double column, bool refine) const {
    const int c0 = std::clamp(static_cast<int>(column), 0, flank_.columns - 1);
    const bool node_column = column == c0;
    const auto at_node = [&](int r) { return node_column ? nodes_[flank_.index(r, c0)] : value_at(r, column); };
    int best = -1, first = -1, last = -1;
    double value = kNever;
    for (int r = 0; r < flank_.rows; ++r) {
      const double f = at_node(r);
      if (f == kNever) continue;
      if (first < 0) first = r;
      last = r;
      if (f > value) value = f, best = r;
    }
    if (best < 0) return -1;
    // Where the pinion's involute ends between two nodes its edge is a place of its own.
    const double low = first > 0 ? edge(column, first, first - 1) : 0;
    const double high = last + 1 < flank_.rows ? edge(column, last, last + 1) : flank_.rows - 1;
    const double from = std::max(low, double(best - 1)), to = std::min(high, double(best + 1));
    double row = best;
    if (refine) row = golden_place([&](double r) { return value_at(r, column); }, from, to);
    for (const double end : {low, high})
      if (value_at(end, column) > value_at(row, column)) row = end;
    return row;
  }
  /// Row between `inside` and `outside` where the asked turn ceases to exist, on the inside.
  [[nodiscard]] double edge(double column, double inside, double outside) const {
    for (int k = 0; k < 48; ++k) {
      const double middle = (inside + outside) / 2;
      (value_at(middle, column) > kNever ? inside : outside) = middle;
    }
    return inside;
  }

  const ContactFlank& flank_;
  const Pinion<double>& pinion_;
  const modification::Field* on_pinion_;
  GearTurn turn_;
  bool exact_, any_ = false;
  std::vector<double> nodes_;
};

}  // namespace toothpath::contact
