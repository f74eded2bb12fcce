#include "app/fit/placing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::fit {
namespace {

using tooth_space::Piece;
using tooth_space::ToothSpace;

constexpr int kStations = 13, kHeights = 7;  // of places on a flank from which a search begins
constexpr std::size_t kTries = 3;            // of them, the nearest ones
constexpr int kTurns = 720;                  // tried over a pitch
constexpr std::size_t kTurnedPoints = 2000;  // by which a turn is judged
constexpr double kBelow = 0.02;              // of the flank's height: so far beyond its end a point still counts,
constexpr double kCorner = 0.02;             // and so near a fillet that cuts it away it counts no more,
constexpr double kAbove = 0.25;              // and so far above its tip,
constexpr double kAhead = 0.25;              // and of the face so far before its ends

/// Places all over a piece, from which searches on it begin.
struct Starts {
  struct Start {
    double u = 0, v = 0, s = 0, h = 0;
  };
  const ToothSpace* space = nullptr;
  Piece piece = Piece::flank_plus;
  std::vector<Start> list = {};

  /// h there; nothing where the piece has no place.
  std::optional<double> add(double u, double s) {
    const auto& chart = space->outline().chart;
    const auto v = tooth_space::v_at(*space, piece, u, s);
    const auto at = v ? space->at(piece, u, *v) : std::nullopt;
    if (!at) return {};
    list.push_back({u, *v, chart.along(at->p), chart.up(at->p)});
    return list.back().h;
  }
  [[nodiscard]] std::optional<tooth_space::PiecePlace> search(double s, double h) const {
    const auto far = [&](const Start& a) { return (a.s - s) * (a.s - s) + (a.h - h) * (a.h - h); };
    std::array<const Start*, kTries> near{};
    for (const Start& start : list) {
      const Start* candidate = &start;
      for (const Start*& slot : near)
        if (slot == nullptr || far(*candidate) < far(*slot)) std::swap(slot, candidate);
    }
    for (const Start* start : near)
      if (start != nullptr)
        if (auto found = tooth_space::search_place(*space, piece, s, h, {start->u, start->v})) return found;
    return {};
  }
};

/// A flank and the fillet that follows it.
struct Flank {
  const ToothSpace* space = nullptr;
  int side = 1;
  double end = 0, height = 0;  ///< u where the fillet begins; from there to the tip, where it is highest
  double tall = 0;             ///< the same in mm
  Starts flank, fillet;
  bool undercut = false;  ///< somewhere the fillet stands higher than where the flank should end

  Flank(const ToothSpace& of, int on)
      : space(&of), side(on), flank{&of, tooth_space::flank_of(on)}, fillet{&of, tooth_space::fillet_of(on)} {
    const auto& outline = of.outline();
    const tooth_space::Borders borders = of.borders(flank.piece), below = of.borders(fillet.piece);
    end = std::isfinite(borders.to) && side > 0 ? borders.to : borders.from;
    const double top = side > 0 ? below.from : below.to, root = side > 0 ? below.to : below.from;
    std::optional<tooth_space::EdgePlace> tip;
    for (int k = 0; k < kStations; ++k) {
      const double s = outline.s_from + (outline.s_to - outline.s_from) * k / (kStations - 1);
      std::optional<double> flank_end;
      if (const auto here = of.tip_edge(side, s, tip)) {
        tip = here;
        const double here_up = here->u - end;
        if (std::abs(here_up) > std::abs(height)) height = here_up;
        for (int n = 0; n < kHeights; ++n) {
          const auto h = flank.add(end + here_up * n / (kHeights - 1), s);
          if (n == 0) flank_end = h;
          if (h && flank_end) tall = std::max(tall, *h - *flank_end);
        }
      }
      for (int n = 0; n < kHeights; ++n)
        if (const auto h = fillet.add(top + (root - top) * n / (kHeights - 1), s); h && n > 0)
          undercut = undercut || !flank_end || *h > *flank_end;
    }
  }

  /// The place with the s and h of a point.
  [[nodiscard]] std::optional<tooth_space::PiecePlace> beside(const Vec3& p) const {
    const auto& outline = space->outline();
    const double s = outline.chart.along(p), face = outline.s_to - outline.s_from;
    if (s < outline.s_from - kAhead * face || s > outline.s_to + kAhead * face) return {};
    const auto found = flank.search(s, outline.chart.up(p));
    return found && (found->u - end) / height < 1 + kAbove ? found : std::nullopt;
  }
  /// Does the fillet take away the flank at this place, nearly, or stand where it has none?
  [[nodiscard]] bool cut_away(const Vec3& p, const std::optional<tooth_space::PiecePlace>& on_flank) const {
    const auto& chart = space->outline().chart;
    const auto in_fillet = undercut ? fillet.search(chart.along(p), chart.up(p)) : std::nullopt;
    if (!in_fillet || !space->borders(fillet.piece).hold(in_fillet->u, 0)) return false;
    return !on_flank || side * radius(p) * wrapped(azimuth(in_fillet->at.p) - azimuth(on_flank->at.p)) < kCorner * tall;
  }
  [[nodiscard]] bool holds(double u) const { return (u - end) / height > -kBelow; }
};

/// A point against one flank of its zone: how far ahead of it in azimuth it lies.
struct Beside {
  double ahead = 0, u = 0, v = 0;
  bool found = false;
};
struct Candidate {
  std::size_t point = 0;
  int zone = 0;
  double r = 0;
  std::array<Beside, 2> sides{};  ///< +1, -1
  /// Of the sides that may be, the one nearer after a turn.
  [[nodiscard]] std::pair<std::size_t, double> nearer(double turn, double pitch) const {
    std::pair<std::size_t, double> best{0, INFINITY};
    for (std::size_t k = 0; k < 2; ++k)
      if (const double off = std::remainder(sides[k].ahead - turn, pitch);
          sides[k].found && std::abs(off) < std::abs(best.second))
        best = {k, off};
    return best;
  }
};

/// As the point's normal says it, or else the file.
int known_side(const flank_grid::LoosePoint& point) {
  if (!point.n) return point.flank;
  return point.n->y() * point.p.x() - point.n->x() * point.p.y() > 0 ? 1 : -1;
}

int zone_of(const Spaces& spaces, const Vec3& p) {
  int best = 0;
  double least = INFINITY;
  for (std::size_t zone = 0; zone < spaces.size(); ++zone) {
    const auto& outline = spaces[zone]->outline();
    const double s = outline.chart.along(p), off = std::max({outline.s_from - s, s - outline.s_to, 0.0});
    if (off < least) least = off, best = int(zone);
  }
  return best;
}

/// The turn about which all points lie nearest to flanks.
double best_turn(const std::vector<Candidate>& candidates, double pitch) {
  const std::size_t every = std::max<std::size_t>(1, candidates.size() / kTurnedPoints);
  double best = 0, least = INFINITY;
  for (int k = 0; k < kTurns; ++k) {
    const double turn = pitch * (double(k) / kTurns - 0.5);
    double cost = 0;
    for (std::size_t i = 0; i < candidates.size(); i += every) {
      const double off = candidates[i].r * candidates[i].nearer(turn, pitch).second;
      cost += off * off;
    }
    if (cost < least) least = cost, best = turn;
  }
  double sum = 0, weight = 0;
  for (const Candidate& c : candidates) sum += c.nearer(best, pitch).second, weight += 1;
  return weight > 0 ? best + sum / weight : best;
}

}  // namespace

Placing placed_on(const Spaces& spaces, const job::LoosePoints& points, const Pose& pose, bool turns) {
  std::vector<std::array<Flank, 2>> flanks;
  for (const auto& space : spaces) flanks.push_back({Flank(*space, 1), Flank(*space, -1)});
  Placing out;
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const auto& point = points.points[i];
    const Vec3 p = pose.in_space(point.p, 0);
    Candidate candidate{i, zone_of(spaces, p), radius(p)};
    bool below = false, found = false;
    for (std::size_t k = 0; k < 2; ++k) {
      if (const int side = known_side(point); side != 0 && side != (k == 0 ? 1 : -1)) continue;
      const Flank& flank = flanks[std::size_t(candidate.zone)][k];
      const auto at = flank.beside(p);
      const bool cut = flank.cut_away(p, at);
      below = below || cut;
      if (!at || cut) continue;
      const bool on = flank.holds(at->u);
      below = below || !on;
      found = found || on;
      candidate.sides[k] = {azimuth(p) - azimuth(at->at.p), at->u, at->v, on};
    }
    if (found) candidates.push_back(candidate);
    else ++(below ? out.below_flanks : out.beside);
  }
  if (candidates.empty()) return out;
  const double pitch = spaces.front()->outline().pitch, turn = turns ? best_turn(candidates, pitch) : 0;
  out.turn_rad = pose.turn_rad + turn;
  for (const Candidate& c : candidates) {
    const auto [k, off] = c.nearer(turn, pitch);
    const Beside& side = c.sides[k];
    out.points.push_back(
        {c.point, c.zone, k == 0 ? 1 : -1, int(std::lround((side.ahead - turn - off) / pitch)), side.u, side.v});
  }
  return out;
}

}  // namespace toothpath::fit
