#include "geometry/tooth_space/tooth_space.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toothpath::tooth_space {

std::optional<PatchFoot> ToothSpace::next_foot(Piece piece, const Vec3& c, const PatchFoot& near) const {
  const auto f = foot(piece, c, near.u, near.v);
  if (!f) return {};
  const PatchPoint& q = f->at;
  const Vec3 parallel = (q.pu + f->distance * q.nu).cross(q.pv + f->distance * q.nv);
  return parallel.dot(q.pu.cross(q.pv)) > 0 ? f : std::nullopt;
}

namespace {

/// Does a curve that starts at one end of `way` and has this slope over a step stay within `slack` of it?
bool stays(const Interval& slope, double step, double way, double slack) {
  const Interval moves = slope * Interval(step);
  return std::min(0.0, moves.low) >= std::min(0.0, way) - slack &&
         std::max(0.0, moves.high) <= std::max(0.0, way) + slack;
}

/// How far the bounds may lie apart; looser ones are sought in halves.
struct Spread {
  double slope = 0, bend = 0;
  [[nodiscard]] bool holds(const CurveBend& curve) const {
    return curve.slope.high - curve.slope.low <= slope && curve.bend.high - curve.bend.low <= bend;
  }
};

/// In one box about the stretch.
std::optional<CurveBend> azimuth_in_box(const ToothSpace& space, int side, const EdgePlace& from, double s_from,
                                        const EdgePlace& to, double s_to) {
  const Chart& chart = space.outline().chart;
  const CurveBend tip = space.tip_bend(s_from, s_to);
  const Vec2 a(from.u, from.v), b(to.u, to.v), way = b - a;
  const PatchFrame frame{0.5 * (a + b), Vec2::UnitX(), Vec2::UnitY()};
  // Boxes around the stretch, wider and wider: the curve must be seen to stay in one. Where it hardly moves in u, the
  // spread of its slope comes from the length of the box in v alone.
  struct Room {
    double growth, of_u, of_v;
  };
  for (const Room& room :
       {Room{0.2, 1e-6, 1e-6}, {2, 1e-6, 1e-6}, {2, 1e-4, 1e-4}, {2, 1e-2, 1e-2}, {2, 1e-4, 0}, {2, 1e-2, 0}}) {
    const double du = room.growth * std::abs(way.x()) + room.of_u, dv = room.growth * std::abs(way.y()) + room.of_v;
    const auto jet = space.enclosure(flank_of(side), frame, 0.5 * std::abs(way.x()) + du, 0.5 * std::abs(way.y()) + dv);
    if (!jet) continue;
    // The edge is h = tip(s): with s for its parameter, two linear equations for (u', v') and again for (u'', v'').
    const BoxCoordinate s(*jet, chart.cosine, -chart.sine), h(*jet, chart.sine, chart.cosine);
    const Interval det = s.first[0] * h.first[1] - s.first[1] * h.first[0];
    const auto solved = [&](const Interval& of_s, const Interval& of_h) {
      return std::array{(h.first[1] * of_s - s.first[1] * of_h) / det, (s.first[0] * of_h - h.first[0] * of_s) / det};
    };
    const auto first = solved(Interval(1), tip.slope);
    const Interval &u1 = first[0], &v1 = first[1];
    if (!stays(u1, s_to - s_from, way.x(), du) || !stays(v1, s_to - s_from, way.y(), dv)) continue;
    const auto bent = [&](const std::array<Interval, 3>& second) {
      return along(second[0], second[1], second[2], u1, v1);
    };
    const auto next = solved(-bent(s.second), tip.bend - bent(h.second));
    // The azimuth's derivatives along the edge.
    const Interval &x = jet->place[0], &y = jet->place[1], q = square(x) + square(y);
    const auto along_edge = [&](std::size_t k) { return jet->first[0][k] * u1 + jet->first[1][k] * v1; };
    const auto bent_edge = [&](std::size_t k) {
      return along(jet->second[0][k], jet->second[1][k], jet->second[2][k], u1, v1) + jet->first[0][k] * next[0] +
             jet->first[1][k] * next[1];
    };
    const Interval x1 = along_edge(0), y1 = along_edge(1), slope = (x * y1 - y * x1) / q;
    const Interval bend = (x * bent_edge(1) - y * bent_edge(0)) / q - Interval(2) * slope * (x * x1 + y * y1) / q;
    if (slope.finite() && bend.finite()) return CurveBend{slope, bend};
  }
  return {};
}

std::optional<CurveBend> azimuth_of_edge(const ToothSpace& space, int side, const EdgePlace& from, double s_from,
                                         const EdgePlace& to, double s_to, const Spread& spread, int halvings) {
  const auto whole = azimuth_in_box(space, side, from, s_from, to, s_to);
  if (halvings == 0 || (whole && spread.holds(*whole))) return whole;
  const double s_middle = 0.5 * (s_from + s_to);
  const auto middle = space.tip_edge(side, s_middle, from);
  if (!middle) return whole;
  const auto first = azimuth_of_edge(space, side, from, s_from, *middle, s_middle, spread, halvings - 1);
  const auto second =
      first ? azimuth_of_edge(space, side, *middle, s_middle, to, s_to, spread, halvings - 1) : std::nullopt;
  if (!second) return whole;
  return CurveBend{hull(first->slope, second->slope), hull(first->bend, second->bend)};
}

}  // namespace

double ToothSpace::tip_s(double station) const {
  constexpr int kSteps = 100;
  const Outline& ring = outline();
  if (!ring.leaning) return station;
  // Ends lean less than a tip surface may rise: the steps shrink.
  double s = station;
  for (int k = 0; k < kSteps; ++k) {
    const double next = ring.s_at(station, tip(s));
    if (std::abs(next - s) <= 1e-15 * std::abs(s)) return next;
    s = next;
  }
  return s;
}

double ToothSpace::highest_tip() const {
  constexpr int kStretches = 256;
  const Outline& ring = outline();
  double highest = std::max(tip(ring.s_from), tip(ring.s_to));
  const double bend = tip_bend(ring.s_from, ring.s_to).bend.magnitude();
  const double step = (ring.s_to - ring.s_from) / kStretches;
  if (bend * step * step < 1e-12) return highest;  // straight
  for (int k = 1; k < kStretches; ++k) highest = std::max(highest, tip(ring.s_from + k * step));
  return highest + 0.125 * bend * step * step;
}

std::optional<CurveBend> ToothSpace::tip_azimuth(int side, const EdgePlace& from, double s_from, const EdgePlace& to,
                                                 double s_to) const {
  constexpr int kHalvings = 9;     // near the place where a flank folds back bounds are loose
  constexpr double kLoose = 2e-4;  // mm: of how far the edge leaves its chord, by what its bounds lie apart
  // The edge leaves its chord by an eighth of step^2 times radius (slope^2 + bend).
  const double s = 0.5 * (s_from + s_to), step = s_to - s_from, r = outline().chart.r(s, tip(s)),
               most = 8 * kLoose / (step * step * r), slope = std::abs(to.azimuth - from.azimuth) / std::abs(step);
  // (slope + x)^2 - slope^2 = most / 2
  const Spread spread{std::sqrt(slope * slope + 0.5 * most) - slope, 0.5 * most};
  return azimuth_of_edge(*this, side, from, s_from, to, s_to, spread, kHalvings);
}

}  // namespace toothpath::tooth_space
