#include "geometry/tooth_space/tooth_space.h"

#include <algorithm>
#include <utility>

namespace toothpath::tooth_space {

std::optional<PatchFoot> ToothSpace::next_foot(Piece piece, const Vec3& c, const PatchFoot& near) const {
  const auto f = foot(piece, c, near.u, near.v);
  if (!f) return {};
  const PatchPoint& q = f->at;
  const Vec3 parallel = (q.pu + f->distance * q.nu).cross(q.pv + f->distance * q.nv);
  return parallel.dot(q.pu.cross(q.pv)) > 0 ? f : std::nullopt;
}

std::optional<CurveBend> ToothSpace::tip_azimuth(int side, const EdgePlace& from, double s_from, const EdgePlace& to,
                                                 double s_to) const {
  const Chart& chart = outline().chart;
  const CurveBend tip = tip_bend(s_from, s_to);
  const Vec2 a(from.u, from.v), b(to.u, to.v), way = (b - a).cwiseAbs();
  const PatchFrame frame{0.5 * (a + b), Vec2::UnitX(), Vec2::UnitY()};
  // Where the edge hardly moves in u, the spread of its slope comes from the length of the box in v alone.
  for (const auto& [of_u, of_v] : {std::pair(1e-6, 1e-6), {1e-4, 1e-4}, {1e-2, 1e-2}, {1e-4, 0.0}, {1e-2, 0.0}}) {
    const double du = 2 * way.x() + of_u, dv = 2 * way.y() + of_v;
    const auto jet = enclosure(flank_of(side), frame, 0.5 * way.x() + du, 0.5 * way.y() + dv);
    if (!jet) continue;
    // The edge is h = tip(s): with s for its parameter, two linear equations for (u', v') and again for (u'', v'').
    const BoxCoordinate s(*jet, chart.cosine, -chart.sine), h(*jet, chart.sine, chart.cosine);
    const Interval det = s.first[0] * h.first[1] - s.first[1] * h.first[0];
    const auto solved = [&](const Interval& of_s, const Interval& of_h) {
      return std::array{(h.first[1] * of_s - s.first[1] * of_h) / det, (s.first[0] * of_h - h.first[0] * of_s) / det};
    };
    const auto first = solved(Interval(1), tip.slope);
    const Interval &u1 = first[0], &v1 = first[1];
    // Followed from its first place, the edge cannot leave the box within the step.
    if (!(u1.magnitude() * (s_to - s_from) <= du) || !(v1.magnitude() * (s_to - s_from) <= dv)) continue;
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

}  // namespace toothpath::tooth_space
