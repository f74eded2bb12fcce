// Grids of points from gears in closed form, for tests.
#pragma once

#include "geometry/flank_grid/gear.h"
#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/limits.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/straight_bevel/samples.h"

namespace toothpath::test {

struct Sampling {
  int rows = 7, columns = 9;
  double ball_mm = 1;
  bool falling = false;  ///< columns and meridians run against s
  double turn = 0;       ///< of everything about the axis, rad
  double below = 0;      ///< share of the height that rows begin below the end of the flank
};

/// The flanks of a space from fillet to tip and from end to end, its root and tip.
inline flank_grid::FlankGridParameters sampled(const tooth_space::ToothSpace& space, int teeth, const Sampling& ask) {
  using tooth_space::Piece;
  flank_grid::FlankGridParameters g;
  g.teeth = teeth;
  g.fillet_radius_mm = ask.ball_mm;
  const auto& ring = space.outline();
  const auto station = [&](int k, int count) {
    const double t = double(ask.falling ? count - 1 - k : k) / (count - 1);
    return ring.s_from + t * (ring.s_to - ring.s_from);
  };
  for (const int end : {0, 1}) {
    const double s = station(end, 2);
    const Vec3 root = tooth_space::place_at(space, Piece::root, 0.5, s)->p;
    g.root.emplace_back(radius(root), root.z());
    g.tip.emplace_back(ring.chart.r(s, space.tip(s)), ring.chart.z(s, space.tip(s)));
  }
  for (const int side : {1, -1}) {
    const Piece piece = tooth_space::flank_of(side);
    const tooth_space::Borders b = space.borders(piece);
    const double foot = std::isfinite(b.from) ? b.from : b.to;
    auto& out = side > 0 ? g.plus : g.minus;
    out.rows = ask.rows;
    out.columns = ask.columns;
    for (int i = 0; i < ask.rows; ++i)
      for (int j = 0; j < ask.columns; ++j) {
        const double s = station(j, ask.columns), tip = space.tip_edge(side, s)->u;
        const auto q = tooth_space::place_at(
            space, piece, foot + (tip - foot) * ((1 + ask.below) * i / (ask.rows - 1) - ask.below), s);
        out.place.push_back(turned(q->p, ask.turn));
        out.normal.push_back(turned(q->n, ask.turn));
      }
  }
  return g;
}
inline flank_grid::FlankGridParameters sampled(const straight_bevel::StraightBevelParameters& g, const Sampling& ask) {
  return sampled(straight_bevel::StraightBevelGear::make(g).value().space(), g.teeth, ask);
}

inline flank_grid::FlankGridParameters sampled(const cylindrical::CylindricalParameters& g, const Sampling& ask) {
  return sampled(made(g).space(0), g.teeth, ask);
}

/// A blank that is no even slice of the gear whose flanks it has.
struct Blank {
  double lean_from = 0, lean_to = 0;  ///< s for each mm of h of the ends, about the middle of the height
  double wave = 0;                    ///< by which rows and columns bend, as a share of height and length
  double root_mm = 0, tip_mm = 0;     ///< by which both rise in the middle of the teeth, over their straight lines
};

/// The flanks between leaning ends, over rows and columns that bend, and root and tip by three points each.
inline flank_grid::FlankGridParameters sampled(const tooth_space::ToothSpace& space, int teeth, const Sampling& ask,
                                               const Blank& blank) {
  using tooth_space::Piece;
  flank_grid::FlankGridParameters g;
  g.teeth = teeth;
  g.fillet_radius_mm = ask.ball_mm;
  const auto& ring = space.outline();
  const auto root_h = [&](double s) { return ring.chart.up(tooth_space::place_at(space, Piece::root, 0.5, s)->p); };
  const double middle = 0.5 * (ring.s_from + ring.s_to), h_middle = 0.5 * (root_h(middle) + space.tip(middle));
  const tooth_space::EndLine from{ring.s_from, h_middle, blank.lean_from}, to{ring.s_to, h_middle, blank.lean_to};
  /// (s, h) at a share of the length, at a height that s says.
  const auto place = [&](double share, const auto& height) {
    Vec2 at(middle, h_middle);
    for (int k = 0; k < 60; ++k) {
      at.x() = from.at(at.y()) + share * (to.at(at.y()) - from.at(at.y()));
      at.y() = height(at.x());
    }
    return at;
  };
  for (const double t : {0.0, 0.5, 1.0}) {
    const double share = ask.falling ? 1 - t : t, rise = t == 0.5 ? 1 : 0;
    const Vec2 root = place(share, [&](double s) { return root_h(s) + rise * blank.root_mm; }),
               tip = place(share,
                           [&](double s) { return space.tip(s) + rise * blank.tip_mm - std::max(0.0, blank.tip_mm); });
    g.root.emplace_back(ring.chart.r(root.x(), root.y()), ring.chart.z(root.x(), root.y()));
    g.tip.emplace_back(ring.chart.r(tip.x(), tip.y()), ring.chart.z(tip.x(), tip.y()));
  }
  for (const int side : {1, -1}) {
    const Piece piece = tooth_space::flank_of(side);
    const tooth_space::Borders b = space.borders(piece);
    const double foot = std::isfinite(b.from) ? b.from : b.to;
    auto& out = side > 0 ? g.plus : g.minus;
    out.rows = ask.rows;
    out.columns = ask.columns;
    for (int i = 0; i < ask.rows; ++i)
      for (int j = 0; j < ask.columns; ++j) {
        const double x = double(ask.falling ? ask.columns - 1 - j : j) / (ask.columns - 1),
                     y = double(i) / (ask.rows - 1), along = x + blank.wave * std::sin(kPi * x) * std::sin(kTwoPi * y),
                     up = y + blank.wave * std::sin(kPi * y) * std::sin(kTwoPi * x);
        const Vec2 at = place(along, [&](double s) {
          const double low = ring.chart.up(tooth_space::place_at(space, piece, foot, s)->p);
          return low + up * (space.tip(s) - low);
        });
        const double u = foot + up * (space.tip_edge(side, at.x())->u - foot);
        const auto q = tooth_space::search_place(space, piece, at.x(), at.y(),
                                                 {u, tooth_space::v_at(space, piece, u, at.x()).value()});
        out.place.push_back(turned(q->at.p, ask.turn));
        out.normal.push_back(turned(q->at.n, ask.turn));
      }
  }
  return g;
}

}  // namespace toothpath::test
