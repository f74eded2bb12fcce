#include "geometry/tooth_space/limits.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/followed.h"
#include "geometry/tooth_space/tooth_size.h"

namespace toothpath::tooth_space {
namespace {

constexpr int kHalvings = 60;

/// u of the flank of a side where it meets the tip surface at s.
std::optional<double> tip_u(const ToothSpace& space, int side, double s) {
  const auto edge = space.tip_edge(side, s);
  return edge ? std::optional(edge->u) : std::nullopt;
}

/// Least distance from a place to the wall of a side, less `radius`.
double room(const ToothSpace& space, double s, int side, const Vec3& centre, double radius) {
  constexpr int kStarts = 9;
  double least = INFINITY;
  for (const Piece piece : {fillet_of(side), flank_of(side)}) {
    Borders b = space.borders(piece);
    if (is_flank(piece)) {
      const auto tip = tip_u(space, side_of(piece), s);
      if (!tip) continue;
      (std::isfinite(b.from) ? b.to : b.from) = *tip;
    }
    for (int k = 0; k < kStarts; ++k) {
      const double u = b.from + (b.to - b.from) * k / (kStarts - 1);
      const auto start = place_at(space, piece, u, s);
      if (!start) continue;
      const auto v = space.start_v(piece, u, s, 0, {}, 1);
      const auto foot = v ? space.foot(piece, centre, u, *v) : std::nullopt;
      if (foot && b.hold(foot->u, 1e-9)) least = std::min(least, foot->distance - radius);
    }
  }
  return least;
}

}  // namespace

std::optional<double> v_at(const ToothSpace& space, Piece piece, double u, double s) {
  constexpr int kSteps = 20;
  const Chart& chart = space.outline().chart;
  const auto solved = [&](double v, double at_u) -> std::optional<double> {
    for (int k = 0; k < kSteps; ++k) {
      const auto q = space.at(piece, at_u, v);
      if (!q) return {};
      const double lack = s - chart.along(q->p);
      if (std::abs(lack) <= 1e-11 * (1 + std::abs(s))) return v;
      v += lack / chart.along(q->p, q->pv);
    }
    return {};
  };
  const auto from_starts = [&](double at_u) -> std::optional<double> {
    for (int attempt = 0; attempt < ToothSpace::kStarts; ++attempt)
      if (const auto start = space.start_v(piece, at_u, s, 0, {}, attempt))
        if (const auto v = solved(*start, at_u)) return v;
    return {};
  };
  if (const auto v = from_starts(u)) return v;
  if (!is_fillet(piece)) return {};
  // Beside an undercut v runs quickly up a fillet: from the root.
  const Borders b = space.borders(piece);
  const double root = side_of(piece) > 0 ? b.to : b.from;
  const auto v = from_starts(root);
  return v ? followed<double>(*v, root, u, 0.0, solved) : std::nullopt;
}

std::optional<double> v_at_station(const ToothSpace& space, Piece piece, double u, double station) {
  constexpr int kSteps = 60;
  const Outline& ring = space.outline();
  double s = station;
  for (int k = 0; k < kSteps; ++k) {
    const auto v = v_at(space, piece, u, s);
    if (!v || !ring.leaning) return v;
    const auto q = space.point(piece, u, *v);
    if (!q) return {};
    const double next = ring.s_at(station, ring.chart.up(q->p));
    if (std::abs(next - s) <= 1e-11 * (1 + std::abs(s))) return v;
    s = next;
  }
  return {};
}

std::optional<PatchPoint> place_at(const ToothSpace& space, Piece piece, double u, double s) {
  const auto v = v_at(space, piece, u, s);
  return v ? space.at(piece, u, *v) : std::nullopt;
}

namespace {
/// By how much the azimuth of a flank grows from its fillet to the tip surface at s, counted on through whole turns.
std::optional<double> turn_of_flank(const ToothSpace& space, int side, double s, double tip_u) {
  constexpr int kRises = 64;
  const Borders b = space.borders(flank_of(side));
  const double fillet = std::isfinite(b.from) ? b.from : b.to;
  double turn = 0, last = 0;
  for (int n = 0; n <= kRises; ++n) {
    const auto q = place_at(space, flank_of(side), fillet + (tip_u - fillet) * n / kRises, s);
    if (!q) return {};
    const double now = azimuth(q->p);
    if (n > 0) turn += wrapped(now - last);
    last = now;
  }
  return turn;
}
}  // namespace

double top_land_mm(const ToothSpace& space, double s) {
  const auto plus = space.tip_edge(1, s), minus = space.tip_edge(-1, s);
  if (!plus || !minus) return 0;
  const double land = wrapped(plus->azimuth - minus->azimuth);
  // Flanks that go on far beyond where they meet come round the axis again; at their fillets they are a tooth apart.
  const auto up = turn_of_flank(space, 1, s, plus->u), down = turn_of_flank(space, -1, s, minus->u);
  if (!up || !down) return 0;
  const double turn = *up - *down, rounds = std::round((wrapped(land - turn) + turn - land) / kTwoPi);
  return space.outline().chart.r(s, space.tip(s)) * (land + kTwoPi * rounds);
}

std::optional<PatchPoint> middle_of_flank(const ToothSpace& space, int side, double s) {
  const Borders b = space.borders(flank_of(side));
  const auto low = place_at(space, flank_of(side), std::isfinite(b.from) ? b.from : b.to, s);
  if (!low) return {};
  const auto middle = flank_at(space, side, s, 0.5 * (space.outline().chart.up(low->p) + space.tip(s)));
  return middle ? std::optional(middle->at) : std::nullopt;
}

double fillet_radius_min_mm(const ToothSpace& space, double s, int side) {
  constexpr int kPlaces = 65;
  // The curvature of a fillet grows towards the root or has one top on the way: the best of a grid, closed in on.
  const Piece fillet = fillet_of(side);
  const Borders b = space.borders(fillet);
  const auto hollow = [&](double u) {
    const auto q = place_at(space, fillet, u, s);
    return q ? -principal_curvatures(*q).least : 0.0;
  };
  const auto place = [&](int k) { return b.from + (b.to - b.from) * std::clamp(k, 0, kPlaces - 1) / (kPlaces - 1); };
  int best = 0;
  double most = -INFINITY;
  for (int k = 0; k < kPlaces; ++k)
    if (const double h = hollow(place(k)); h > most) most = h, best = k;
  double low = place(best - 1), high = place(best + 1);
  for (int k = 0; k < kHalvings; ++k) {
    const double a = low + (high - low) / 3, c = high - (high - low) / 3;
    (hollow(a) < hollow(c) ? low : high) = hollow(a) < hollow(c) ? a : c;
  }
  most = std::max(most, hollow(0.5 * (low + high)));
  return most > 0 ? 1 / most : 0;
}

double root_ball_radius_mm(const ToothSpace& space, double s) {
  constexpr int kDoublings = 10, kPlaces = 14;
  constexpr double kAlike = 1e-7;  // mm
  double from = 0, to = 1, largest = 0;
  // From the middle of the root away from the wall that stops the ball first.
  for (int n = 0; n < kPlaces; ++n) {
    const double u = 0.5 * (from + to);
    const auto root = place_at(space, Piece::root, u, s);
    if (!root) break;
    const auto at = [&](int side, double R) { return room(space, s, side, root->p + R * root->n, R); };
    const auto fits = [&](double R) { return at(1, R) >= 0 && at(-1, R) >= 0; };
    double fit = 0, stuck = std::max(space.tip(s) - space.outline().chart.up(root->p), 1e-6);
    for (int k = 0; k < kDoublings && fits(stuck); ++k) stuck *= 2;
    for (int k = 0; k < kHalvings && stuck - fit > 1e-12 * stuck; ++k) {
      const double middle = 0.5 * (fit + stuck);
      (fits(middle) ? fit : stuck) = middle;
    }
    largest = std::max(largest, fit);
    const double plus = at(1, fit), minus = at(-1, fit);
    if (std::abs(plus - minus) < kAlike) break;
    (plus < minus ? from : to) = u;
  }
  return largest;
}

}  // namespace toothpath::tooth_space
