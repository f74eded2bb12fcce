#include "cam/analytic/ring_edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace toothpath::analytic {
namespace {

constexpr double kSag = 5e-6;         // mm: where a proven sag is larger, smaller boxes are tried
constexpr std::size_t kStretch = 60;  // segments that are bounded together, at most

/// Segments from .. to, whose places are all of one piece, but perhaps the last.
void prove(const tooth_space::ToothSpace& space, const std::vector<EndPlace>& places, std::size_t from, std::size_t to,
           std::vector<double>& sags) {
  const std::size_t last = places[to].piece == places[from].piece ? to : to - 1;
  const std::size_t back = last > from || from == 0 ? from : from - 1;
  if (places[back].piece != places[from].piece || last == back) return;
  // The coordinate a runs along the stretch, b along the parameter v.
  const Vec2 x(places[back].u, places[back].v), y(places[last].u, places[last].v);
  const PatchFrame frame{0.5 * (x + y), 0.5 * (y - x), Vec2(0, 1)};
  double off = 0, step = last == from ? 2 : 0;
  for (std::size_t k = from; k <= last; ++k) {
    const Vec2 ab = frame.ab({places[k].u, places[k].v});
    off = std::max(off, std::abs(ab.y()));
    if (k > from) step = std::max(step, std::abs(ab.x() - frame.ab({places[k - 1].u, places[k - 1].v}).x()));
  }
  const double half_a = last == to ? 1 : 1 + 1.01 * step;  // the border to the next piece is a step farther
  bool good = false;
  for (double half_b = 2 * off + 1e-6; half_b < 1; half_b *= 5) {
    const auto bend = end_curve_bend(space, places[from].piece, frame, half_a, half_b);
    if (!bend) continue;
    good = true;
    for (std::size_t k = from; k < to; ++k) {  // only what leads away from the chord counts
      const Vec3 chord = (places[k + 1].p - places[k].p).normalized();
      sags[k] = 0.125 * step * step * ((bend->middle - chord.dot(bend->middle) * chord).norm() + bend->spread);
      good = good && sags[k] <= kSag;
    }
    break;
  }
  if (good || to - from < 2) return;
  const std::size_t middle = (from + to) / 2;
  prove(space, places, from, middle, sags);
  prove(space, places, middle, to, sags);
}

}  // namespace

std::vector<double> end_edge_sags(const tooth_space::ToothSpace& space, const std::vector<EndPlace>& places) {
  std::vector<double> sags(places.size(), -1);
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t from = 0, to = 0; from + 1 < places.size(); from = to) {
    to = from + 1;
    while (to + 1 < places.size() && to < from + kStretch && places[to].piece == places[from].piece) ++to;
    stretches.emplace_back(from, to);
  }
  tbb::parallel_for(std::size_t(0), stretches.size(),
                    [&](std::size_t n) { prove(space, places, stretches[n].first, stretches[n].second, sags); });
  return sags;
}

std::vector<std::optional<CurveBend>> tip_bends(const tooth_space::ToothSpace& space, int side,
                                                const std::vector<std::optional<tooth_space::EdgePlace>>& places,
                                                const std::vector<double>& stations) {
  std::vector<std::optional<CurveBend>> bends(places.empty() ? 0 : places.size() - 1);
  tbb::parallel_for(std::size_t(0), bends.size(), [&](std::size_t k) {
    if (places[k] && places[k + 1])
      bends[k] = space.tip_azimuth(side, *places[k], stations[k], *places[k + 1], stations[k + 1]);
  });
  return bends;
}

TipMeridian::TipMeridian(const tooth_space::ToothSpace& space, double s_from, double s_to) {
  const tooth_space::Chart& chart = space.outline().chart;
  const CurveBend h = space.tip_bend(s_from, s_to);
  z2 = chart.cosine * h.bend;
  if (chart.sine == 0) {
    r = Interval(s_from, s_to);
    r1 = 1.0;
    r2 = 0.0;
    return;
  }
  // By the mean value theorem about the middle.
  const double middle = 0.5 * (s_from + s_to), half = 0.5 * (s_to - s_from);
  r1 = Interval(chart.cosine) + chart.sine * h.slope;
  r2 = chart.sine * h.bend;
  const double way = r1.magnitude() * half * (1 + 1e-12), r_middle = chart.r(middle, space.tip(middle)),
               rounding = 1e-14 * std::abs(r_middle);
  r = Interval(r_middle - way - rounding, r_middle + way + rounding);
}

std::vector<double> tip_edge_sags(const tooth_space::ToothSpace& space,
                                  const std::vector<std::optional<CurveBend>>& bends,
                                  const std::vector<double>& stations) {
  std::vector<double> sags;
  for (std::size_t k = 0; k < bends.size(); ++k) {
    if (!bends[k]) {
      sags.push_back(-1);
      continue;
    }
    // (r cos A, r sin A, z): second derivatives r'' - r A'^2 outwards, 2 r' A' + r A'' along the circle, z'' upwards.
    const TipMeridian tip(space, stations[k], stations[k + 1]);
    const double step = stations[k + 1] - stations[k], r = tip.r.magnitude(), a1 = bends[k]->slope.magnitude(),
                 a2 = bends[k]->bend.magnitude();
    sags.push_back(
        0.125 * step * step *
        std::hypot(tip.r2.magnitude() + r * a1 * a1, 2 * tip.r1.magnitude() * a1 + r * a2, tip.z2.magnitude()));
  }
  return sags;
}

}  // namespace toothpath::analytic
