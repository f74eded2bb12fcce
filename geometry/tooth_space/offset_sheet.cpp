#include "geometry/tooth_space/offset_sheet.h"

#include <algorithm>
#include <cmath>

namespace toothpath::tooth_space {
namespace {

// Nodes per piece: flanks bend slowly, fillets turn by more than 60 degrees.
constexpr int kNodes[kPieces] = {56, 28, 8, 28, 56};

// A crossing closer than this in sigma is one place seen from two pieces, or too small to hold a thousandth of a
// micrometre.
constexpr double kLeastGap = 0.01;

/// Crossing of segments a0 a1 and b0 b1; parameters in [0, 1] or nothing.
std::optional<std::pair<double, double>> crossing(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) {
  const Vec2 u = a1 - a0, v = b1 - b0, w = b0 - a0;
  const double det = u.x() * v.y() - u.y() * v.x();
  if (det == 0) return {};
  const double s = (w.x() * v.y() - w.y() * v.x()) / det, t = (w.x() * u.y() - w.y() * u.x()) / det;
  if (s < 0 || s > 1 || t < 0 || t > 1) return {};
  return std::pair{s, t};
}

}  // namespace

SheetCorner corner_of(const SheetGap& gap) {
  constexpr double kRootBegins = double(Piece::root), kRootEnds = kRootBegins + 1;
  if (gap.from < kRootBegins && gap.to > kRootEnds) return SheetCorner::both;
  return gap.from < kRootBegins ? SheetCorner::plus : SheetCorner::minus;
}

OffsetSheet::OffsetSheet(const ToothSpace& space, double delta, double r_from, double r_to, int stations)
    : space_(&space), delta_(delta) {
  // u at the tip surface as a straight line in r that stays at or above the tip on the whole range.
  const auto tip_line = [&](int side, double(&line)[2]) {
    std::vector<std::pair<double, double>> samples;
    std::optional<EdgePlace> last;
    for (int k = 0; k <= 16; ++k) {
      const double r = r_from + (r_to - r_from) * k / 16;
      const auto c = space.plain_tip_edge(side, r, last);
      if (!c) continue;
      last = c;
      samples.push_back({r, c->u});
    }
    if (samples.size() < 2) {
      line[0] = samples.empty() ? 0.0 : samples[0].second;
      line[1] = 0;
      return;
    }
    line[1] = (samples.back().second - samples.front().second) / (samples.back().first - samples.front().first);
    // Away from the fillet, at whichever end of u that lies.
    const Borders b = space.borders(flank_of(side));
    const double out = (side > 0 ? b.from : b.to) < 0 ? -1 : 1;
    line[0] = -out * INFINITY;
    for (const auto& [r, u] : samples)
      line[0] = out < 0 ? std::min(line[0], u - line[1] * r) : std::max(line[0], u - line[1] * r);
    line[0] += out * std::abs(line[1]) * delta_;  // r here is of the contact, later of the centre
  };
  tip_line(1, top_plus_);
  tip_line(-1, top_minus_);

  std::vector<Station> all = regular_stations(r_from, r_to, stations);
  if (delta_ > 0)
    for (auto& s : all) {
      find_gaps(s);
      has_gaps_ = has_gaps_ || !s.gaps.empty();
    }
  stations_ = std::move(all);
  if (has_gaps_)
    for (auto& s : stations_)
      for (auto& g : s.gaps) (void)refine_gap(g, s.r);
}

std::vector<OffsetSheet::Station> OffsetSheet::regular_stations(double r_from, double r_to, int count) const {
  const auto radius_of = [&](int k) { return r_from + (r_to - r_from) * k / (count - 1); };
  std::vector<Station> all;
  for (int k = 0; k < count; ++k) {
    auto s = make_station(radius_of(k), all.empty() ? nullptr : &all.back());
    if (s) {
      all.push_back(std::move(*s));
    } else if (!all.empty()) {
      break;  // beyond the regular sheet
    }
  }
  if (all.empty() || int(all.size()) == count) return all;
  // The surface begins or ends inside the range (near the undercut): find where, then space the stations evenly.
  const auto last_good = [&](double good, double bad, const Station& from) {
    for (int k = 0; k < 20; ++k) {
      const double middle = 0.5 * (good + bad);
      (make_station(middle, &from) ? good : bad) = middle;
    }
    return good;
  };
  const double step = (r_to - r_from) / (count - 1);
  double low = all.front().r, high = all.back().r;
  if (low > r_from) low = last_good(low, low - step, all.front());
  if (high < r_to) high = last_good(high, high + step, all.back());
  for (int round = 0; round < 4 && high > low; ++round) {
    const std::vector<Station> before = std::move(all);
    all.clear();
    for (int k = 0; k < count; ++k) {
      const double r = low + (high - low) * k / (count - 1);
      const Station* from = all.empty() ? nullptr : &all.back();
      for (const auto& s : before)
        if (from == nullptr || (all.empty() && std::abs(s.r - r) < std::abs(from->r - r))) from = &s;
      auto s = make_station(r, from);
      if (!s) break;
      all.push_back(std::move(*s));
    }
    if (int(all.size()) == count) return all;
    if (all.empty()) {
      low += 0.01 * (high - low);
      all = before;
    } else {
      high = all.back().r;
    }
  }
  return {};
}

double OffsetSheet::parameter(Piece piece, double t, double r) const {
  Borders b = space_->borders(piece);
  if (piece == Piece::flank_plus) b.from = top_plus_[0] + top_plus_[1] * r;
  if (piece == Piece::flank_minus) b.to = top_minus_[0] + top_minus_[1] * r;
  return b.from + t * (b.to - b.from);
}

std::optional<SheetPoint> OffsetSheet::solve(Piece piece, double u, double r, double v_start) const {
  SheetPoint s;
  s.piece = piece;
  s.u = u;
  s.v = v_start;
  const double limit = space_->longest_step(piece, r), enough = 1e-12 * size(r);
  for (int k = 0; k < 40; ++k) {
    const auto q = space_->at(piece, u, s.v);
    if (!q) return {};
    s.contact = *q;
    s.centre = q->p + delta_ * q->n;
    const double error = r - chart().along(s.centre);
    if (std::abs(error) < enough) return s;
    const double step = error / chart().along(s.centre, q->pv + delta_ * q->nv);
    if (!std::isfinite(step)) return {};
    s.v += std::clamp(step, -limit, limit);
  }
  return {};
}

std::optional<OffsetSheet::Station> OffsetSheet::make_station(double r, const Station* neighbour) const {
  Station station;
  station.r = r;
  std::size_t index = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const auto kind = Piece(piece);
    for (int k = 0; k <= kNodes[piece]; ++k, ++index) {
      const double t = double(k) / kNodes[piece], u = parameter(kind, t, r);
      // From the same place of the neighbour, or within one section from edge to edge.
      std::optional<Near> near;
      if (neighbour != nullptr) near = {neighbour->nodes[index].at.v, neighbour->r};
      else if (!is_flank(kind) && (k > 0 || kind != Piece::fillet_plus)) near = {station.nodes.back().at.v, r};
      std::optional<SheetPoint> s;
      for (int attempt = 0; attempt < ToothSpace::kStarts && !s; ++attempt)
        if (const auto v = space_->start_v(kind, u, r, delta_, near, attempt)) s = solve(kind, u, r, *v);
      if (!s) return {};
      Node node;
      node.sigma = piece + t;
      node.at = *s;
      node.azimuth = std::atan2(s->centre.y(), s->centre.x());
      if (!station.nodes.empty())
        node.azimuth = station.nodes.back().azimuth +
                       std::remainder(node.azimuth - station.nodes.back().azimuth, 6.283185307179586);
      station.nodes.push_back(std::move(node));
    }
  }
  return station;
}

void OffsetSheet::find_gaps(Station& station) const {
  const std::size_t n = station.nodes.size();
  std::vector<Vec2> plane;
  const double about = size(station.r);
  for (const auto& node : station.nodes) plane.push_back({node.azimuth * about, chart().up(node.at.centre)});
  const auto apart = [&](std::size_t a, std::size_t b) {
    const auto [a0, a1] = std::minmax(plane[a].x(), plane[a + 1].x());
    const auto [b0, b1] = std::minmax(plane[b].x(), plane[b + 1].x());
    return a1 < b0 || b1 < a0;
  };
  std::size_t k = 0;
  while (k + 1 < n) {
    // One segment may cross several others: the offset is left at the first place along it, for the farthest of those
    // that meet there.
    std::size_t hit = 0;
    std::pair<double, double> at(INFINITY, 0);
    for (std::size_t j = n - 2; j > k + 1; --j) {
      if (apart(k, j)) continue;
      const auto c = crossing(plane[k], plane[k + 1], plane[j], plane[j + 1]);
      if (!c || c->first > at.first - 1e-9) continue;
      const double left_at = station.nodes[k].sigma + c->first * (station.nodes[k + 1].sigma - station.nodes[k].sigma);
      if (station.nodes[j].sigma - left_at < kLeastGap && hit != 0) continue;
      hit = j;
      at = *c;
    }
    if (hit == 0) {
      ++k;
      continue;
    }
    const auto blend = [&](std::size_t j, double t) {
      return station.nodes[j].sigma + t * (station.nodes[j + 1].sigma - station.nodes[j].sigma);
    };
    const SheetGap gap{blend(k, at.first), blend(hit, at.second)};
    // Two pieces share the place where they join: neighbouring copies of one point are no crossing.
    if (gap.to - gap.from > kLeastGap) station.gaps.push_back(gap);
    k = gap.to - gap.from > kLeastGap ? hit : k + 1;  // the next corner may begin on the very same segment
  }
}

bool OffsetSheet::refine_gap(SheetGap& gap, double r) const {
  const double about = size(r);
  const auto centre = [&](double sigma) -> std::optional<Vec2> {
    const auto s = raw(sigma, r);
    if (!s) return {};
    return Vec2(std::atan2(s->centre.y(), s->centre.x()) * about, chart().up(s->centre));
  };
  constexpr double kStep = 1e-5;
  SheetGap g = gap;
  for (int k = 0; k < 30; ++k) {
    const auto a = centre(g.from), b = centre(g.to), a1 = centre(g.from + kStep), b1 = centre(g.to + kStep);
    if (!a || !b || !a1 || !b1) return false;
    const Vec2 F = *a - *b, da = (*a1 - *a) / kStep, db = (*b1 - *b) / kStep;
    if (F.norm() < 1e-11 * std::max(1.0, about)) {
      if (!(g.to > g.from)) return false;
      gap = g;
      return true;
    }
    const double det = -da.x() * db.y() + db.x() * da.y();
    if (det == 0) return false;
    double ds = (F.x() * db.y() - db.x() * F.y()) / det, dt = (-da.x() * F.y() + da.y() * F.x()) / det;
    // (ds, dt) solve  da ds - db dt = -F.
    const double size = std::max(std::abs(ds), std::abs(dt));
    if (size > 0.1) {
      ds *= 0.1 / size;
      dt *= 0.1 / size;
    }
    g.from += ds;
    g.to += dt;
  }
  return false;
}

std::size_t OffsetSheet::station_before(double r) const {
  const double span = r_to() - r_from();
  const double t = span > 0 ? (r - r_from()) / span * double(stations_.size() - 1) : 0;
  return std::size_t(std::clamp(std::floor(t), 0.0, double(stations_.size()) - 2));
}

std::optional<SheetPoint> OffsetSheet::raw(double sigma, double r) const {
  if (stations_.size() < 2) return {};
  const double bounded = std::clamp(sigma, 0.0, double(kPieces));
  const int piece = std::min(int(bounded), kPieces - 1);
  const double t = bounded - piece;
  std::size_t first = 0;
  for (int p = 0; p < piece; ++p) first += std::size_t(kNodes[p]) + 1;
  const std::size_t j = station_before(r);
  const std::size_t k = first + std::size_t(std::min(t * kNodes[piece], kNodes[piece] - 1.0));
  const auto& s0 = stations_[j];
  const auto& s1 = stations_[j + 1];
  const double x = t * kNodes[piece] - double(k - first), y = (r - s0.r) / (s1.r - s0.r);
  const double v = (1 - y) * ((1 - x) * s0.nodes[k].at.v + x * s0.nodes[k + 1].at.v) +
                   y * ((1 - x) * s1.nodes[k].at.v + x * s1.nodes[k + 1].at.v);
  return solve(Piece(piece), parameter(Piece(piece), t, r), r, v);
}

std::vector<SheetGap> OffsetSheet::gaps(double r) const {
  if (!has_gaps_) return {};
  const std::size_t j = station_before(r);
  const auto &s0 = stations_[j], &s1 = stations_[j + 1];
  if (s0.gaps.empty() && s1.gaps.empty()) return {};
  std::vector<SheetGap> out;
  // The same corners at both stations.
  bool ok = std::equal(s0.gaps.begin(), s0.gaps.end(), s1.gaps.begin(), s1.gaps.end(),
                       [](const SheetGap& a, const SheetGap& b) { return corner_of(a) == corner_of(b); });
  if (ok) {
    const double y = (r - s0.r) / (s1.r - s0.r);
    for (std::size_t k = 0; k < s0.gaps.size() && ok; ++k) {
      SheetGap g{(1 - y) * s0.gaps[k].from + y * s1.gaps[k].from, (1 - y) * s0.gaps[k].to + y * s1.gaps[k].to};
      ok = refine_gap(g, r);
      out.push_back(g);
    }
  }
  if (ok) return out;
  // The number of crossings changes between the stations: look at this very profile.
  auto here = make_station(r, &s0);
  if (!here) return {};
  find_gaps(*here);
  for (auto& g : here->gaps) (void)refine_gap(g, r);
  return here->gaps;
}

std::optional<SheetPoint> OffsetSheet::at(double sigma, double r) const {
  if (has_gaps_)
    for (const auto& g : gaps(r))
      if (sigma > g.from && sigma < g.to) {
        sigma = sigma - g.from < g.to - sigma ? g.from : g.to;
        break;
      }
  return raw(sigma, r);
}

}  // namespace toothpath::tooth_space
