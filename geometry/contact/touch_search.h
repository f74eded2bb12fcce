// The first touch of one flank with its mate at one position of the gear: where on the flank, at which turn of the
// mate. Inside of every roll; bevel_contact takes highest_place.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geometry/contact/nearest_turn.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::contact {

/// Where f is highest between lo and hi, to 2e-7 of their distance; an end where f is higher there. Source: Brent 1973,
/// Algorithms for Minimization without Derivatives, ch. 5: parabolas, golden section where they do not close in.
template <typename F>
double highest_place(F&& f, double lo, double hi) {
  constexpr double kGolden = 0.3819660112501051;
  const double enough = 1e-7 * (hi - lo);
  double a = lo, b = hi, x = a + kGolden * (b - a), w = x, v = x, fx = f(x), fw = fx, fv = fx, step = 0, last = 0;
  for (int k = 0; k < 60; ++k) {
    const double middle = (a + b) / 2;
    if (std::abs(x - middle) <= 2 * enough - (b - a) / 2) break;
    bool parabola = false;
    if (std::abs(last) > enough) {
      const double r = (x - w) * (fx - fv), s = (x - v) * (fx - fw), sum = 2 * (s - r), p = (x - v) * s - (x - w) * r,
                   way = p / sum;
      parabola = std::abs(way) < std::abs(last) / 2 && x - way > a && x - way < b;  // never with a place without f
      if (parabola) {
        last = step, step = -way;
        if (x + step - a < 2 * enough || b - x - step < 2 * enough) step = std::copysign(enough, middle - x);
      }
    }
    if (!parabola) last = (x < middle ? b : a) - x, step = kGolden * last;
    const double u = x + (std::abs(step) >= enough ? step : std::copysign(enough, step)), fu = f(u);
    if (fu >= fx) {
      (u < x ? b : a) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
    } else {
      (u < x ? a : b) = u;
      if (fu >= fw || w == x) v = w, fv = fw, w = u, fw = fu;
      else if (fu >= fv || v == x || v == w) v = u, fv = fu;
    }
  }
  const double flo = f(lo), fhi = f(hi);
  if (flo > fx && flo >= fhi) return lo;
  return fhi > fx ? hi : x;
}

/// The last place between `inside` and `outside` where f is not below 0, to `enough` of the places or of f: the rule of
/// false position with the Illinois correction. @param f  not below 0 inside
template <typename F>
double last_inside(F&& f, double inside, double outside, double enough) {
  double in = f(inside), out = f(outside), least = in;
  for (int k = 0, side = 0; k < 100 && least > enough && std::abs(inside - outside) > enough; ++k) {
    const double middle = inside + (outside - inside) * in / (in - out), by = f(middle);
    if (by >= 0) {
      inside = middle, in = least = by;
      if (side > 0) out /= 2;
      side = 1;
    } else {
      outside = middle, out = by;
      if (side < 0) in /= 2;
      side = -1;
    }
  }
  return inside;
}

/// The search for the first touch on one flank at one position of the gear: the highest asked turn over the grid and
/// between its nodes. What the flank touches is the member's: a ContactMember or a ToothedMember.
template <typename Member>
class TouchSearch {
 public:
  TouchSearch(const Member& member, double phi_2)
      : member_(member), flank_(member.flank), phi_2_(phi_2), turn_(phi_2), exact_(member.flank.exact()) {
    nodes_.resize(flank_.points.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      nodes_[k] = member.asked_turn(turn_(flank_.points[k] + flank_.deviation_mm[k] * flank_.normals[k]), phi_2);
      if (nodes_[k] > kNever) any_ = true;
    }
    for (int c = 0; c < flank_.columns; ++c) {
      Rows& rows = columns_.emplace_back();
      for (int r = 0; r < flank_.rows; ++r) rows.take(r, nodes_[flank_.index(r, c)]);
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
      const double next = highest_place(along, from, to);
      const bool at_end = (next == from && from > 0) || (next == to && to < flank_.columns - 1);
      column = next;
      if (!at_end) break;
    }
    TouchPlace place;
    place.column = column;
    place.row = row_of(column, true);
    const Vec3 normal = place_at(place.row, column, place.point);
    place.phi_1 = flank_.side * value_at(place.row, column);
    place.lever_mm = member_.lever_mm(turn_(place.point), turn_(normal));
    return place;
  }

 private:
  /// Rows of a column that are on the mate's flank, and the best of them; -1: none.
  struct Rows {
    int first = -1, last = -1, best = -1;
    double value = kNever;
    void take(int r, double f) {
      if (f == kNever) return;
      if (first < 0) first = r;
      last = r;
      if (f > value) value = f, best = r;
    }
  };
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
  /// @returns the normal there
  Vec3 place_at(double row, double column, Vec3& point) const {
    const Cell c = cell(row, column);
    const auto p = flank_.at(blend(flank_.u(), c), blend(flank_.v(), c));
    point = exact_ ? p.p : Vec3(p.p + blend(flank_.deviation_mm, c) * p.n);
    return p.n;
  }
  [[nodiscard]] Vec3 point_at(double row, double column) const {
    Vec3 point;
    (void)place_at(row, column, point);
    return point;
  }
  [[nodiscard]] double value_at(double row, double column) const {
    return row < 0 ? kNever : member_.asked_turn(turn_(point_at(row, column)), phi_2_);
  }
  /// Highest asked turn of a node column: the parabola through the best node and its neighbours, or the edge of the
  /// mate's flank.
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
  /// Of a column between two columns of nodes. An exact flank is smooth: its best row lies about those of its two
  /// neighbours, and the search goes on while it is the last that was asked.
  [[nodiscard]] Rows rows_between(int c0, double column) const {
    const Rows &a = columns_[static_cast<std::size_t>(c0)], &b = columns_[static_cast<std::size_t>(c0) + 1];
    Rows rows;
    if (!exact_ || a.best < 0 || b.best < 0) {
      for (int r = 0; r < flank_.rows; ++r) rows.take(r, value_at(r, column));
      return rows;
    }
    const auto there = [&](int r) { return r >= 0 && r < flank_.rows && on_mate(r, column); };
    const auto end_from = [&](int r, int way) {  // the last row that way, from one that is near it
      if (!there(r)) do
          r -= way;
        while (r >= 0 && r < flank_.rows && !there(r));
      while (there(r + way)) r += way;
      return r;
    };
    rows.first = end_from(std::min(a.first, b.first), -1);
    if (rows.first >= flank_.rows) return {};  // narrower than a row
    rows.last = end_from(std::max({a.last, b.last, rows.first}), 1);
    int low = std::clamp(std::min(a.best, b.best) - 1, rows.first, rows.last),
        high = std::clamp(std::max(a.best, b.best) + 1, rows.first, rows.last);
    const auto take = [&](int r) {
      if (const double f = value_at(r, column); f > rows.value) rows.value = f, rows.best = r;
    };
    for (int r = low; r <= high; ++r) take(r);
    while (rows.best == low && low > rows.first) take(--low);
    while (rows.best == high && high < rows.last) take(++high);
    return rows;
  }
  /// The best row of a column; with `refine` between the nodes. -1: none is within the mate's flank.
  [[nodiscard]] double row_of(double column, bool refine) const {
    const int c0 = std::clamp(static_cast<int>(column), 0, flank_.columns - 1);
    const Rows rows = column == c0 ? columns_[static_cast<std::size_t>(c0)] : rows_between(c0, column);
    if (rows.best < 0) return -1;
    // Where the mate's flank ends between two nodes its edge is a place of its own.
    const double low = rows.first > 0 ? edge(column, rows.first, rows.first - 1) : 0;
    const double high = rows.last + 1 < flank_.rows ? edge(column, rows.last, rows.last + 1) : flank_.rows - 1;
    double row = rows.best;
    if (refine)
      row =
          highest_place([&](double r) { return value_at(r, column); }, std::max(low, row - 1), std::min(high, row + 1));
    double value = value_at(row, column);
    for (const double end : {low, high})
      if (const double at_end = value_at(end, column); at_end > value) row = end, value = at_end;
    return row;
  }
  [[nodiscard]] bool on_mate(double row, double column) const { return inside_by(row, column) >= 0; }
  /// By how much the place lies inside the mate's flank, mm; below 0 outside.
  [[nodiscard]] double inside_by(double row, double column) const {
    return member_.inside_by(turn_(point_at(row, column)));
  }
  /// Row between `inside` and `outside` where the mate's flank ends, on the inside, to 1e-12 mm or rows.
  [[nodiscard]] double edge(double column, double inside, double outside) const {
    return last_inside([&](double row) { return inside_by(row, column); }, inside, outside, 1e-12);
  }

  const Member& member_;
  const decltype(Member::flank)& flank_;
  double phi_2_;
  Turn turn_;
  bool exact_, any_ = false;
  std::vector<double> nodes_;
  std::vector<Rows> columns_;
};

}  // namespace toothpath::contact
