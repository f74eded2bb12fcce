// The top land of `BodyPatches`: the tip surface between the two tip edges of tooth 0, which are solved at every
// station.
#include <algorithm>
#include <cmath>

#include "cam/analytic/body_patches.h"
#include "cam/analytic/ring_edges.h"

namespace toothpath::analytic {
double BodyPatches::edge_azimuth(int which, double s) const {
  const auto& t = ring_.table_s;
  const auto n = std::size_t(which);
  const double x = std::clamp((s - t.front()) / (t.back() - t.front()), 0.0, 1.0) * double(t.size() - 1);
  const auto k = std::min(std::size_t(x), t.size() - 2);
  const double share = x - double(k);
  const auto &a = ring_.tip[n][k], &b = ring_.tip[n][k + 1];
  if (a && b) {
    if (share == 0) return a->azimuth;
    if (share == 1) return b->azimuth;
    tooth_space::EdgePlace start = *a;
    start.u += share * (b->u - a->u);
    start.v += share * (b->v - a->v);
    if (const auto place = space_.tip_edge(which == 0 ? 1 : -1, s, start)) return place->azimuth;
  }
  return ring_.edge[n][k] + share * (ring_.edge[n][k + 1] - ring_.edge[n][k]);
}

Vec3 BodyPatches::land(double share, double s) const {
  const double minus = edge_azimuth(1, s), plus = edge_azimuth(0, s);
  return chart().place(s, minus + share * (plus - minus), space_.tip(s));
}

PatchBend BodyPatches::land_bend(double s_from, double s_to) {
  const auto& t = ring_.table_s;
  std::array<std::optional<CurveBend>, 2> edge;
  std::array<Interval, 2> azimuth;
  bool proven = true;
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      if (t[k + 1] < s_from + 1e-9 || t[k] > s_to - 1e-9) continue;
      const auto& a = ring_.tip[n][k];
      const auto& bend = ring_.tip_bend[n][k];
      if (!a || !bend) {
        proven = false;
        continue;
      }
      const double way = bend->slope.magnitude() * (t[k + 1] - t[k]);
      const Interval here(a->azimuth - way, a->azimuth + way);
      azimuth[n] = edge[n] ? hull(azimuth[n], here) : here;
      edge[n] = edge[n] ? CurveBend{hull(edge[n]->slope, bend->slope), hull(edge[n]->bend, bend->bend)} : *bend;
    }
  if (proven && edge[0] && edge[1]) {
    // p = (r cos A, r sin A, z) with A = m + share w, w = plus - minus; r, z and A change with s.
    const TipMeridian tip(space_, s_from, s_to);
    const Interval w = azimuth[0] - azimuth[1], w1 = edge[0]->slope - edge[1]->slope;
    const Interval A = hull(azimuth[0], azimuth[1]), A1 = hull(edge[0]->slope, edge[1]->slope),
                   A2 = hull(edge[0]->bend, edge[1]->bend);
    const Interval c = cos(A), s = sin(A);
    const auto placed = [&](const Interval& out, const Interval& side, const Interval& z) {
      return std::array<Interval, 3>{out * c - side * s, out * s + side * c, z};
    };
    const std::array<std::array<Interval, 3>, 3> second{
        placed(-tip.r * w * w, 0.0, 0.0), placed(-tip.r * w * A1, tip.r1 * w + tip.r * w1, 0.0),
        placed(tip.r2 - tip.r * A1 * A1, Interval(2) * tip.r1 * A1 + tip.r * A2, tip.z2)};
    if (const auto bend = PatchBend::of(second)) return *bend;
  }
  ++sampled_;
  PatchBend bend;
  const double h = 0.5 * (s_to - s_from), middle = 0.5 * (s_from + s_to);
  for (const double share : {0.0, 0.5, 1.0}) {
    bend.spread_bb = std::max(
        bend.spread_bb,
        kSampleDoubt * (land(share, middle - h) - 2 * land(share, middle) + land(share, middle + h)).norm() / (h * h));
    bend.spread_aa =
        std::max(bend.spread_aa, kSampleDoubt * 4 * (land(0, middle) - 2 * land(0.5, middle) + land(1, middle)).norm());
    bend.spread_ab = std::max(
        bend.spread_ab,
        kSampleDoubt * (land(1, middle + h) - land(1, middle - h) - land(0, middle + h) + land(0, middle - h)).norm() /
            (2 * h));
  }
  return bend;
}

}  // namespace toothpath::analytic
