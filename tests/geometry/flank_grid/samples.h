// Grids of points from gears in closed form, for tests.
#pragma once

#include "geometry/flank_grid/gear.h"
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

}  // namespace toothpath::test
