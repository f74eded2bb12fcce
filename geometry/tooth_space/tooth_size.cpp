#include "geometry/tooth_space/tooth_size.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/base/angle.h"
#include "geometry/base/golden_section.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::tooth_space {
namespace {

constexpr int kFlankHalvings = 60, kBallSteps = 60;
constexpr double kStandsOut = 0.02;     // of the diameter: a flat anvil must find the ball above the tips
constexpr double kBallArrived = 1e-11;  // of the diameter

Vec3 turned(const Vec3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}

/// Steps of the diameters in a shop's box of measuring balls.
double usual_step(double diameter_mm) { return diameter_mm < 2 ? 0.05 : diameter_mm < 10 ? 0.25 : 1; }

}  // namespace

std::optional<FlankPlace> flank_at(const ToothSpace& space, int side, double s, double h) {
  const Piece piece = flank_of(side);
  const Chart& chart = space.outline().chart;
  const auto tip = space.tip_edge(side, s);
  if (!tip) return {};
  const Borders b = space.borders(piece);
  double low = std::isfinite(b.from) ? b.from : b.to, high = tip->u;
  const auto at_u = [&](double u) -> std::optional<FlankPlace> {
    const auto v = v_at(space, piece, u, s);
    const auto q = v ? space.at(piece, u, *v) : std::nullopt;
    return q ? std::optional(FlankPlace{u, *v, *q}) : std::nullopt;
  };
  const auto first = at_u(low), last = at_u(high);
  const double slack = 1e-9 * (1 + std::abs(h));
  if (!first || !last || chart.up(first->at.p) > h + slack || chart.up(last->at.p) < h - slack) return {};
  std::optional<FlankPlace> q;
  for (int k = 0; k < kFlankHalvings; ++k) {
    const double u = 0.5 * (low + high);
    q = at_u(u);
    if (!q) return {};
    (chart.up(q->at.p) < h ? low : high) = u;
  }
  return q;
}

std::optional<ToothThickness> tooth_thickness(const ToothSpace& space, double s, double h) {
  const Outline& ring = space.outline();
  const auto plus = flank_at(space, 1, s, h), minus = flank_at(space, -1, s, h);
  if (!plus || !minus) return {};
  ToothThickness out;
  const double gap = wrapped(azimuth(minus->at.p) - azimuth(plus->at.p));
  out.arc_mm = ring.chart.r(s, h) * (ring.pitch - gap);
  // Both jaws of a caliper: `apart` along the tooth, one before s, the other as far behind it.
  const auto jaws = [&](double apart) -> std::optional<std::pair<Vec3, Vec3>> {
    const auto a = flank_at(space, -1, s + apart, h), b = flank_at(space, 1, s - apart, h);
    if (!a || !b) return {};
    return std::pair{a->at.p, turned(b->at.p, ring.pitch)};
  };
  const auto length = [&](double apart) {
    const auto at = jaws(apart);
    return at ? (at->first - at->second).norm() : INFINITY;
  };
  GoldenSection<std::function<double(double)>, std::less_equal<>> search(-0.6 * out.arc_mm, 0.6 * out.arc_mm, length);
  while (search.width() > 1e-9 * (1 + out.arc_mm)) search.step();
  const auto at = jaws(search.best().first);
  if (!at) return {};
  out.chord_mm = (at->first - at->second).norm();
  const Vec3 middle = 0.5 * (at->first + at->second);
  out.height_mm = space.tip(ring.chart.along(middle)) - ring.chart.up(middle);
  return out;
}

std::optional<BallInSpace> ball_in_space(const ToothSpace& space, double s, double diameter_mm) {
  const Chart& chart = space.outline().chart;
  const double radius = 0.5 * diameter_mm;
  const auto plus = middle_of_flank(space, 1, s), minus = middle_of_flank(space, -1, s);
  if (!plus || !minus) return {};
  const Vec3 start = 0.5 * (plus->p + minus->p) + 0.5 * radius * (plus->n + minus->n);
  double phi = azimuth(start), h = chart.up(start);
  std::optional<FlankPlace> near[2] = {flank_at(space, 1, s, chart.up(plus->p)),
                                       flank_at(space, -1, s, chart.up(minus->p))};
  if (!near[0] || !near[1]) return {};
  BallInSpace out{diameter_mm, {}, {}};
  for (int step = 0; step < kBallSteps; ++step) {
    out.centre = chart.place(s, phi, h);
    const Vec3 by_phi(-out.centre.y(), out.centre.x(), 0), by_h = chart.up_at(phi);
    double lack[2], slope_phi[2], slope_h[2];
    for (int k = 0; k < 2; ++k) {
      const auto foot = space.foot(flank_of(k == 0 ? 1 : -1), out.centre, near[k]->u, near[k]->v);
      if (!foot) return {};
      *near[k] = {foot->u, foot->v, foot->at};
      lack[k] = foot->distance - radius;
      slope_phi[k] = foot->at.n.dot(by_phi);
      slope_h[k] = foot->at.n.dot(by_h);
    }
    if (std::max(std::abs(lack[0]), std::abs(lack[1])) <= kBallArrived * diameter_mm) {
      for (int k = 0; k < 2; ++k) {
        const int side = k == 0 ? 1 : -1;
        const Vec3& p = near[k]->at.p;
        out.touch_h[k] = chart.up(p);
        if (!space.borders(flank_of(side)).hold(near[k]->u, 0) || out.touch_h[k] > space.tip(chart.along(p))) return {};
      }
      return out;
    }
    const double det = slope_phi[0] * slope_h[1] - slope_phi[1] * slope_h[0];
    if (!(std::abs(det) > 0)) return {};
    phi -= (lack[0] * slope_h[1] - lack[1] * slope_h[0]) / det;
    h -= (slope_phi[0] * lack[1] - slope_phi[1] * lack[0]) / det;
  }
  return {};
}

std::optional<BallInSpace> measuring_ball(const ToothSpace& space, double s, double h) {
  const Chart& chart = space.outline().chart;
  // The ball that touches at h would stand on both normals there; its diameter grows with the height of the touch.
  const auto plus = flank_at(space, 1, s, h), minus = flank_at(space, -1, s, h);
  if (!plus || !minus) return {};
  const Vec3 apart = minus->at.p - plus->at.p, turning = plus->at.n - minus->at.n;
  const double about = 2 * apart.dot(turning) / turning.squaredNorm();
  if (!(about > 0)) return {};
  const double step = usual_step(about), middle = std::round(about / step) * step;
  constexpr int kTried = 24;  // steps to either side: normals of curved flanks do not meet
  std::optional<BallInSpace> best;
  double least = INFINITY;
  for (int k = -kTried; k <= kTried; ++k) {
    if (middle + k * step <= 0) continue;
    const auto ball = ball_in_space(space, s, middle + k * step);
    if (!ball || chart.up(ball->centre) + 0.5 * ball->diameter_mm < space.tip(s) + kStandsOut * ball->diameter_mm)
      continue;
    const double off = std::abs(0.5 * (ball->touch_h[0] + ball->touch_h[1]) - h);
    if (off < least) least = off, best = ball;
  }
  return best;
}

}  // namespace toothpath::tooth_space
