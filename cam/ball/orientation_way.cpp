#include "cam/ball/orientation_way.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace toothpath::ball {
namespace {

constexpr double kMostTurn = 0.25;    // rad/mm
constexpr double kFirstWindow = 0.2;  // tangent about the reference
constexpr double kSameStep = 1e-9;    // mm
constexpr double kWhole = 10;         // beyond any grid
constexpr int kRepairs = 60;          // steps that are not clear half-way and must be gone around
constexpr std::size_t kBatch = 32;    // candidates looked at together

/// The grid about every station: what is clear, as far as it was asked.
class Lattice {
 public:
  Lattice(const OrientationWay& way, const LeanGrid& grid, const LeanReference& reference, const LeanIsClear& clear)
      : way_(way), grid_(grid), clear_(clear), known_(way.s.size() * grid.leans.size(), kUnknown) {
    for (std::size_t k = 0; k < way.s.size(); ++k) reference_.push_back(reference(k));
    const auto width = std::size_t(2 * grid.half + 1);
    index_.assign(width * width, -1);
    for (std::size_t g = 0; g < grid.cells.size(); ++g)
      index_[cell(grid.cells[g].first, grid.cells[g].second)] = int(g);
  }

  /// Asks for all leans within `window` of the reference that are not known yet.
  void ask(double window) {
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < way_.s.size(); ++k)
      for (std::size_t g = 0; g < grid_.leans.size(); ++g)
        if (known_[at(k, g)] == kUnknown && (grid_.leans[g] - reference_[k]).lpNorm<Eigen::Infinity>() <= window)
          open.push_back(at(k, g));
    tbb::parallel_for(std::size_t(0), open.size(), [&](std::size_t n) {
      const std::size_t k = open[n] / grid_.leans.size(), g = open[n] % grid_.leans.size();
      known_[open[n]] = clear_(k, grid_.leans[g]) ? kClear : kBlocked;
    });
  }

  /// Asks for all leans, square by square.
  void ask_all(const LeansInSquare& square) {
    tbb::parallel_for(std::size_t(0), way_.s.size(), [&](std::size_t k) {
      int wide = 1;
      while (wide < 2 * grid_.half + 1) wide *= 2;
      ask_square(k, -grid_.half, -grid_.half, wide, square);
    });
  }

  /// Steps from a lean at a station to one at the next that are not clear half-way.
  using Forbidden = std::set<std::pair<std::size_t, std::size_t>>;

  /// Cheapest ways to every lean of every station, from the stations where a way may begin at `start` (its cost).
  struct Layer {
    std::vector<double> cost;
    std::vector<int> from;  ///< lean at the station before; -1: the way begins here
    [[nodiscard]] double least(std::size_t station, std::size_t leans) const {
      const auto begin = cost.begin() + long(station * leans);
      return *std::min_element(begin, begin + long(leans));
    }
    [[nodiscard]] std::size_t best(std::size_t station, std::size_t leans) const {
      const auto begin = cost.begin() + long(station * leans);
      return std::size_t(std::min_element(begin, begin + long(leans)) - begin);
    }
  };
  [[nodiscard]] Layer layer(const Forbidden& forbidden, const std::vector<double>& start) const {
    const std::size_t n = way_.s.size(), m = grid_.leans.size();
    Layer out{std::vector<double>(n * m, INFINITY), std::vector<int>(n * m, -1)};
    for (std::size_t k = 0; k < n; ++k) {
      const double ds = way_.step(k);
      const int steps = std::max(1, int(std::floor(kMostTurn * ds / grid_.step)));
      for (std::size_t g = 0; g < m; ++g) {
        if (known_[at(k, g)] != kClear) continue;
        const double own = ds * (kLeanWeight * grid_.leans[g].squaredNorm() +
                                 kNearWeight * (grid_.leans[g] - reference_[k]).squaredNorm());
        double best = start[k];
        const auto [x, y] = grid_.cells[g];
        if (k > 0)
          for (int dx = -steps; dx <= steps; ++dx)
            for (int dy = -steps; dy <= steps; ++dy) {
              if (std::abs(x + dx) > grid_.half || std::abs(y + dy) > grid_.half) continue;
              const int h = index_[cell(x + dx, y + dy)];
              if (h < 0 || out.cost[at(k - 1, std::size_t(h))] == INFINITY) continue;
              const double turn = double(dx * dx + dy * dy) * grid_.step * grid_.step;
              const double total = out.cost[at(k - 1, std::size_t(h))] + kTurnWeight * turn / ds;
              if (total >= best || forbidden.count({at(k - 1, std::size_t(h)), at(k, g)}) > 0) continue;
              best = total;
              out.from[at(k, g)] = h;
            }
        out.cost[at(k, g)] = own + best;
      }
    }
    return out;
  }

  /// Grid indices of the cheapest way; empty, with `reached` the number of stations that are, when there is none.
  std::vector<std::size_t> cheapest(const Forbidden& forbidden, std::size_t& reached) const {
    const std::size_t n = way_.s.size(), m = grid_.leans.size();
    std::vector<double> start(n, INFINITY);
    start[0] = 0;
    const Layer layer = this->layer(forbidden, start);
    for (reached = 0; reached < n; ++reached)
      if (layer.least(reached, m) == INFINITY) return {};
    std::size_t begin = 0;
    return back(layer, n - 1, begin);
  }

  /// Strokes over all stations that overlap by so many; empty, with `reached` as above, when kMostStrokes do not do.
  std::vector<WayStroke> strokes(const Forbidden& forbidden, std::size_t overlap, std::size_t& reached) const {
    const std::size_t n = way_.s.size(), m = grid_.leans.size();
    std::vector<Layer> layers;
    std::vector<double> start(n, INFINITY);
    start[0] = 0;
    while (layers.size() < kMostStrokes) {
      layers.push_back(layer(forbidden, start));
      for (reached = n; reached > 0 && layers.back().least(reached - 1, m) == INFINITY;) --reached;
      if (reached == n) break;
      for (std::size_t k = 0; k < n; ++k) start[k] = k + overlap < n ? layers.back().least(k + overlap, m) : INFINITY;
    }
    if (reached < n) return {};
    std::vector<WayStroke> out;
    std::size_t end = n - 1;
    for (auto it = layers.rbegin(); it != layers.rend(); ++it) {
      WayStroke stroke;
      stroke.to = end;
      for (const std::size_t g : back(*it, end, stroke.from)) stroke.lean.push_back(grid_.leans[g]);
      out.insert(out.begin(), stroke);
      end = stroke.from + overlap;
    }
    return out;
  }

  [[nodiscard]] std::size_t index_of(const Vec2& lean) const {
    return std::size_t(index_[cell(int(std::lround(lean.x() / grid_.step)), int(std::lround(lean.y() / grid_.step)))]);
  }
  [[nodiscard]] bool any_clear(std::size_t station) const {
    const auto begin = known_.begin() + long(at(station, 0));
    return std::find(begin, begin + long(grid_.leans.size()), kClear) != begin + long(grid_.leans.size());
  }
  [[nodiscard]] std::size_t at(std::size_t station, std::size_t lean) const {
    return station * grid_.leans.size() + lean;
  }

 private:
  void settle(std::size_t station, int x, int y, int wide, char known) {
    for (int i = x; i < std::min(x + wide, grid_.half + 1); ++i)
      for (int j = y; j < std::min(y + wide, grid_.half + 1); ++j)
        if (const int g = index_[cell(i, j)]; g >= 0) known_[at(station, std::size_t(g))] = known;
  }
  /// The cells from (x, y) on, so many in both directions.
  void ask_square(std::size_t station, int x, int y, int wide, const LeansInSquare& square) {
    if (x > grid_.half || y > grid_.half) return;
    if (wide == 1) {
      const int g = index_[cell(x, y)];
      if (g < 0) return;
      char& known = known_[at(station, std::size_t(g))];
      known = clear_(station, grid_.leans[std::size_t(g)]) ? kClear : kBlocked;
      return;
    }
    const double half = 0.5 * (wide - 1) * grid_.step;
    const Leans all = square(station, Vec2(x * grid_.step + half, y * grid_.step + half), half);
    if (all != Leans::mixed) return settle(station, x, y, wide, all == Leans::all_clear ? kClear : kBlocked);
    for (const int dx : {0, wide / 2})
      for (const int dy : {0, wide / 2}) ask_square(station, x + dx, y + dy, wide / 2, square);
  }

  /// The way of a layer that ends at a station with the best lean, from the station where it begins.
  std::vector<std::size_t> back(const Layer& layer, std::size_t end, std::size_t& begin) const {
    std::vector<std::size_t> way{layer.best(end, grid_.leans.size())};
    for (begin = end; layer.from[at(begin, way.front())] >= 0; --begin)
      way.insert(way.begin(), std::size_t(layer.from[at(begin, way.front())]));
    return way;
  }

  static constexpr char kUnknown = 0, kClear = 1, kBlocked = 2;
  [[nodiscard]] std::size_t cell(int x, int y) const {
    return std::size_t((x + grid_.half) * (2 * grid_.half + 1) + y + grid_.half);
  }

  const OrientationWay& way_;
  const LeanGrid& grid_;
  const LeanIsClear& clear_;
  std::vector<char> known_;
  std::vector<Vec2> reference_;
  std::vector<int> index_;
};

/// Slope at a station: the mean of both sides, limited so that the cubic does not overshoot; 0 at a turning point.
double slope(double left, double right) {
  if (left * right <= 0) return 0;
  const double mean = 0.5 * (left + right), most = 3 * std::min(std::abs(left), std::abs(right));
  return std::copysign(std::min(std::abs(mean), most), mean);
}

}  // namespace

LeanGrid::LeanGrid(double widest_tangent, double step_tangent)
    : step(step_tangent), half(int(std::floor(widest_tangent / step_tangent))) {
  for (int x = -half; x <= half; ++x)
    for (int y = -half; y <= half; ++y)
      if (x * x + y * y <= half * half) cells.emplace_back(x, y);
  std::stable_sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) {
    return a.first * a.first + a.second * a.second < b.first * b.first + b.second * b.second;
  });
  for (const auto& [x, y] : cells) leans.emplace_back(x * step, y * step);
}

double OrientationWay::step(std::size_t station) const {
  const double first = s[1] - s[0], own = station == 0 ? first : s[station] - s[station - 1];
  return std::abs(own - first) < kSameStep ? first : own;  // even stations are told by one number
}

Vec2 OrientationWay::lean_at(double radius) const {
  const bool outward = r.back() >= r.front();
  for (std::size_t k = 1; k < r.size(); ++k) {
    const double a = r[k - 1], b = r[k];
    if (outward ? radius > b : radius < b) continue;
    const double t = b != a ? std::clamp((radius - a) / (b - a), 0.0, 1.0) : 0;
    return lean[k - 1] + t * (lean[k] - lean[k - 1]);
  }
  return lean.back();
}

Vec2 OrientationWay::lean_along(double at, bool smooth) const {
  const std::size_t n = s.size();
  const auto k = std::size_t(std::clamp<long>(std::upper_bound(s.begin(), s.end(), at) - s.begin(), 1, long(n) - 1));
  const double ds = s[k] - s[k - 1], t = ds > 0 ? std::clamp((at - s[k - 1]) / ds, 0.0, 1.0) : 0;
  const Vec2 &a = lean[k - 1], &b = lean[k];
  if (!smooth) return a + t * (b - a);
  Vec2 out;
  for (int i = 0; i < 2; ++i) {
    const double rise = b[i] - a[i];  // slopes are told over this step
    const double m0 = k >= 2 ? slope((a[i] - lean[k - 2][i]) * (step(k) / step(k - 1)), rise) : 0,
                 m1 = k + 1 < n ? slope(rise, (lean[k + 1][i] - b[i]) * (step(k) / step(k + 1))) : 0;
    out[i] = a[i] + t * (m0 + t * (3 * rise - 2 * m0 - m1 + t * (m0 + m1 - 2 * rise)));
  }
  return out;
}

std::optional<Vec2> find_clear_lean(double widest_tangent, double finest, const Vec2& near,
                                    const std::function<Leans(const Vec2& centre, double half)>& square,
                                    const std::function<bool(const Vec2& lean)>& clear) {
  struct Square {
    Vec2 centre;
    double half;
  };
  std::vector<Square> open{{Vec2(0, 0), widest_tangent}};
  while (!open.empty()) {
    const auto [centre, half] = open.back();
    open.pop_back();
    if (centre.norm() - half * std::numbers::sqrt2 > widest_tangent || square(centre, half) == Leans::none_clear)
      continue;
    if (centre.norm() <= widest_tangent && clear(centre)) return centre;
    if (2 * half < finest) continue;
    std::array<Square, 4> parts;
    for (std::size_t k = 0; k < 4; ++k)
      parts[k] = {centre + 0.5 * half * Vec2(k % 2 == 0 ? -1 : 1, k < 2 ? -1 : 1), 0.5 * half};
    std::stable_sort(parts.begin(), parts.end(), [&](const Square& a, const Square& b) {
      return (a.centre - near).squaredNorm() > (b.centre - near).squaredNorm();
    });
    open.insert(open.end(), parts.begin(), parts.end());
  }
  return {};
}

bool find_constant(OrientationWay& way, const LeanGrid& grid, const LeanReference& reference,
                   const LeanIsClear& clear) {
  const std::size_t n = way.s.size();
  Vec2 mean(0, 0);
  for (std::size_t k = 0; k < n; ++k) mean += reference(k) / double(n);
  // Up to a constant, the cost of a lean over the whole pass.
  std::vector<std::pair<double, Vec2>> candidates;
  for (const auto& q : grid.leans)
    candidates.emplace_back(kLeanWeight * q.squaredNorm() + kNearWeight * (q - mean).squaredNorm(), q);
  candidates.emplace_back(kLeanWeight * mean.squaredNorm(), mean);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t from = 0; from < candidates.size(); from += kBatch) {
    const std::size_t count = std::min(kBatch, candidates.size() - from);
    std::vector<char> good(count, 1);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t c) {
      // Both ends first: they are the most likely to be in the way.
      for (std::size_t k = 0; k < n && good[c]; ++k)
        good[c] = clear(k % 2 == 0 ? k / 2 : n - 1 - k / 2, candidates[from + c].second);
    });
    const auto first = std::find(good.begin(), good.end(), 1);
    if (first == good.end()) continue;
    std::fill(way.lean.begin(), way.lean.end(), candidates[from + std::size_t(first - good.begin())].second);
    way.constant = way.solved = true;
    return true;
  }
  return false;
}

WayFound find_way(OrientationWay& way, const LeanGrid& grid, const LeanReference& reference, const LeanIsClear& clear,
                  const HalfWayIsClear& half_way, const LeansInSquare& square) {
  Lattice lattice(way, grid, reference, clear);
  WayFound result;
  for (const double window : {kFirstWindow, kWhole}) {
    if (square && window != kWhole) continue;
    if (square) lattice.ask_all(square);
    else lattice.ask(window);
    Lattice::Forbidden forbidden;
    for (int repair = 0; repair <= kRepairs; ++repair) {
      std::size_t reached = 0;
      const auto found = lattice.cheapest(forbidden, reached);
      result.blocked_at = reached;
      if (found.empty()) break;
      bool good = true;
      for (std::size_t k = 0; k + 1 < found.size(); ++k)
        if (!half_way(k, grid.leans[found[k]], grid.leans[found[k + 1]])) {
          forbidden.insert({lattice.at(k, found[k]), lattice.at(k + 1, found[k + 1])});
          good = false;
          result.blocked_at = k + 1;
        }
      if (!good) continue;
      for (std::size_t k = 0; k < found.size(); ++k) way.lean[k] = grid.leans[found[k]];
      way.constant = false;
      way.solved = result.found = true;
      return result;
    }
  }
  result.blocked_at = std::min(result.blocked_at, way.s.size() - 1);
  result.none_clear = !lattice.any_clear(result.blocked_at);
  return result;
}

std::vector<WayStroke> find_strokes(const OrientationWay& way, const LeanGrid& grid, const LeanReference& reference,
                                    const LeanIsClear& clear, const HalfWayIsClear& half_way, std::size_t& blocked_at,
                                    const LeansInSquare& square) {
  Lattice lattice(way, grid, reference, clear);
  if (square) lattice.ask_all(square);
  else lattice.ask(kWhole);
  for (const std::size_t overlap : {std::size_t(1), std::size_t(0)}) {
    Lattice::Forbidden forbidden;
    for (int repair = 0; repair <= kRepairs; ++repair) {
      auto found = lattice.strokes(forbidden, overlap, blocked_at);
      if (found.empty()) break;
      const std::size_t before = forbidden.size();
      for (const WayStroke& stroke : found)
        for (std::size_t k = stroke.from; k < stroke.to; ++k) {
          const Vec2 &a = stroke.lean[k - stroke.from], &b = stroke.lean[k + 1 - stroke.from];
          if (half_way(k, a, b)) continue;
          forbidden.insert({lattice.at(k, lattice.index_of(a)), lattice.at(k + 1, lattice.index_of(b))});
          blocked_at = k + 1;
        }
      if (forbidden.size() == before) return found;
    }
  }
  blocked_at = std::min(blocked_at, way.s.size() - 1);
  return {};
}

}  // namespace toothpath::ball
