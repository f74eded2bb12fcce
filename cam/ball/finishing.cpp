#include "cam/ball/finishing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "cam/ball/pass_count.h"
#include "cam/ball/sheet_pass.h"
#include "geometry/base/work_share.h"

namespace toothpath::ball {
namespace {

constexpr double kRootBegin = 2,
                 kRootEnd = 3;  // the root land on the sheet; below it plus fillet and flank, above it minus
constexpr int kDrawRounds = 6;  // how often all passes are laid anew, closer where a cusp is too high

/// Cubic through equally spaced values (Catmull-Rom), value at t in [0, n - 1].
double smooth(const std::vector<double>& y, double t) {
  const int n = int(y.size());
  const int k = std::clamp(int(t), 0, n - 2);
  const double x = t - k;
  const auto v = [&](int j) { return y[std::size_t(std::clamp(j, 0, n - 1))]; };
  const double y0 = k > 0 ? v(k - 1) : 2 * v(0) - v(1), y1 = v(k), y2 = v(k + 1);
  const double y3 = k + 2 < n ? v(k + 2) : 2 * v(n - 1) - v(n - 2);
  return y1 + 0.5 * x * (y2 - y0 + x * (2 * y0 - 5 * y1 + 4 * y2 - y3 + x * (3 * (y1 - y2) + y3 - y0)));
}

class FinishingPlanner {
 public:
  FinishingPlanner(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options)
      : sheet_(sheet), o_(options), count_(sheet, options) {}

  Result<FinishingPasses> run() {
    if (sheet_.has_gaps()) passes_between_corners();
    else passes_over_all();
    if (auto ok = make_passes(); !ok) return ok.error();
    return std::move(out_);
  }

 private:
  using Place = std::function<double(double)>;  ///< sigma over the centre radius
  using Chain = std::vector<Place>;             ///< neighbouring passes

  /// The asked regions of the sheet, neighbouring ones as one: from both tips downwards, in turn, so that a climbing
  /// pass on one flank leads to a climbing pass on the other. (Counts of single flanks vary more along the tooth than
  /// the count of the whole space does.)
  void passes_over_all() {
    const std::vector<Chain> chains = drawn_together([this] {
      std::vector<Chain> laid;
      for (const auto& [from, to] : stretches()) laid.push_back(chain_between(from, to));
      return laid;
    });
    Chain chain;
    for (const Chain& c : chains) {
      note_cusps(c);
      chain.insert(chain.end(), c.begin(), c.end());
    }
    const std::size_t all = chain.size(), on_plus = passes_of_plus(chain);
    for (std::size_t i = 0; i < std::max(on_plus, all - on_plus); ++i) {
      if (i < on_plus) add_pass(chain[i], true);
      if (i < all - on_plus) add_pass(chain[all - 1 - i], false);
    }
  }

  /// Ends in sigma of what is covered.
  [[nodiscard]] std::vector<std::pair<double, double>> stretches() const {
    std::vector<std::pair<double, double>> out;
    for (int piece = 0; piece < 5; ++piece) {
      if (!o_.regions[FinishingOptions::region_at(piece + 0.5)]) continue;
      if (!out.empty() && out.back().second == piece) out.back().second = piece + 1;
      else out.emplace_back(piece, piece + 1);
    }
    return out;
  }

  [[nodiscard]] Chain chain_between(double from, double to) const {
    const std::size_t n = sheet_.stations().size();
    std::vector<double> begin(n), counts(n);
    for (std::size_t j = 0; j < n; ++j) {
      begin[j] = count_.count_at(j, from);
      counts[j] = count_.count_at(j, to) - begin[j];
    }
    const int least = from == 0 && to == 5 ? 2 : 1;
    const int passes = std::max(least, int(std::ceil(most_on_ring(counts) - 1e-9)));
    Chain chain;
    for (int index = 0; index < passes; ++index) {
      const double share = (index + 0.5) / passes;
      std::vector<double> sigma;
      for (std::size_t j = 0; j < n; ++j) sigma.push_back(count_.sigma_at(j, begin[j] + share * counts[j]));
      chain.push_back([this, sigma](double r) { return smooth(sigma, station_coordinate(r)); });
    }
    return chain;
  }

  /// How many passes of the chain are fed as those of the plus flank: none that touches the minus fillet, and all that
  /// touch the plus fillet or flank, so that material lies on the asked side of every one. The root land takes either
  /// feed: there the middle of the chain divides.
  [[nodiscard]] std::size_t passes_of_plus(const Chain& chain) const {
    std::size_t clear_of_minus = 0, touching_plus = 0;
    for (const auto& sigma : chain) {
      double least = INFINITY, most = -INFINITY;
      for (const auto& station : sheet_.stations()) {
        least = std::min(least, sigma(station.r));
        most = std::max(most, sigma(station.r));
      }
      if (most <= kRootEnd) ++clear_of_minus;
      if (least < kRootBegin) ++touching_plus;
    }
    const auto [low, high] = std::minmax(clear_of_minus, touching_plus);
    return std::clamp((chain.size() + 1) / 2, low, high);
  }

  [[nodiscard]] int samples() const { return 2 * int(sheet_.stations().size()); }
  [[nodiscard]] double sample_at(int k) const {
    return sheet_.r_from() + (sheet_.r_to() - sheet_.r_from()) * k / samples();
  }
  /// The pass as its neighbours see it at every sample between the ends of the sheet; nothing where the sheet
  /// has no point.
  [[nodiscard]] std::vector<std::optional<PassLine>> lines_of(const Place& sigma) const {
    std::vector<std::optional<tooth_space::SheetPoint>> places;
    for (int k = 0; k <= samples(); ++k) places.push_back(sheet_.at(sigma(sample_at(k)), sample_at(k)));
    const auto centre = [&](std::size_t k) { return places[k] ? std::optional(places[k]->centre) : std::nullopt; };
    std::vector<std::optional<PassLine>> lines(places.size());
    for (std::size_t k = 1; k + 1 < places.size(); ++k)
      if (places[k] && (places[k - 1] || places[k + 1]))
        lines[k] = PassLine(sigma(sample_at(int(k))), *places[k], centre(k - 1), centre(k + 1));
    return lines;
  }

  /// The cusps between the passes of a chain that are higher than a share of what is asked there, on the ring, also
  /// between the stations; one list a pair.
  [[nodiscard]] std::vector<std::vector<HighCusp>> cusps_above(const Chain& chain, double share) const {
    if (chain.empty()) return {};
    std::vector<std::vector<std::optional<PassLine>>> lines(chain.size());
    tbb::parallel_for(std::size_t(0), chain.size(), [&](std::size_t i) { lines[i] = lines_of(chain[i]); });
    std::vector<std::vector<HighCusp>> out(chain.size() - 1);
    tbb::parallel_for(std::size_t(0), chain.size() - 1, [&](std::size_t i) {
      for (int k = 1; k < samples(); ++k) {
        const auto &a = lines[i][std::size_t(k)], &b = lines[i + 1][std::size_t(k)];
        if (!a || !b || !on_ring(*a, *b)) continue;
        const bool flat = std::max(a->sigma, b->sigma) < 0.9 || std::min(a->sigma, b->sigma) > 4.1;
        if (flat && k % 2 != 0) continue;  // the flanks bend slowly
        const double r = sample_at(k);
        const Crest crest = count_.cusp(*a, *b, r, sheet_.gaps(r));
        if (crest.height_mm > share * o_.scallop(a->sigma, b->sigma))
          out[i].push_back({r, std::min(a->sigma, b->sigma), std::max(a->sigma, b->sigma), crest});
      }
    });
    return out;
  }
  /// Does the crest between two passes stand on the ring, or hardly beyond its ends?
  [[nodiscard]] bool on_ring(const PassLine& a, const PassLine& b) const {
    const auto& chart = sheet_.space().outline().chart;
    const auto [low, high] = std::minmax({chart.along(a.at.contact.p), chart.along(b.at.contact.p)});
    const double beyond = high - low + 0.02 * o_.ball_radius_mm;
    const auto& ring = sheet_.space().outline();
    return high > ring.s_from - beyond && low < ring.s_to + beyond;
  }

  /// Of one value a station, the greatest where some contact of the station lies on the ring: beyond its ends no cusp
  /// counts.
  [[nodiscard]] double most_on_ring(const std::vector<double>& values) const {
    const auto& ring = sheet_.space().outline();
    double most = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const auto& nodes = sheet_.stations()[j].nodes;
      const bool on = std::any_of(nodes.begin(), nodes.end(), [&](const tooth_space::OffsetSheet::Node& n) {
        const double s = ring.chart.along(n.at.contact.p);
        return s >= ring.s_from && s <= ring.s_to;
      });
      if (on) most = std::max(most, values[j]);
    }
    return most;
  }

  /// Lays chains with `lay`, draws the passes together where a cusp is too high and lays them anew. A place where the
  /// surface bends sharply would draw all passes together along the whole tooth: of all rounds the one with the fewest
  /// passes is taken, those counted that must then stand between two others.
  template <typename Lay>
  [[nodiscard]] std::vector<Chain> drawn_together(const Lay& lay) {
    std::vector<Chain> best;
    std::size_t fewest = SIZE_MAX;
    WorkShare share(kDrawRounds + 1);
    for (int round = 0; round <= kDrawRounds; ++round) {
      share.add();
      std::vector<Chain> chains = lay();
      std::vector<HighCusp> high;
      std::size_t passes = 0;
      for (const Chain& chain : chains) {
        passes += chain.size();
        for (const auto& pair : cusps_above(chain, 1)) {
          passes += pair.empty() ? 0 : 1;
          high.insert(high.end(), pair.begin(), pair.end());
        }
      }
      if (passes < fewest) {
        fewest = passes;
        best = std::move(chains);
      }
      if (high.empty()) break;
      count_.draw_together(high);
    }
    for (Chain& chain : best) close_gaps(chain);
    return best;
  }

  [[nodiscard]] std::vector<HighCusp> high_cusps(const Chain& chain) const {
    std::vector<HighCusp> all;
    for (const auto& pair : cusps_above(chain, 1)) all.insert(all.end(), pair.begin(), pair.end());
    return all;
  }
  void note_cusps(const Chain& chain) {
    for (const auto& pair : cusps_above(chain, 0))
      for (const auto& c : pair) {
        out_.scallop_max_mm = std::max(out_.scallop_max_mm, c.crest.height_mm);
        out_.crest_lean = std::max(out_.crest_lean, c.crest.lean);
      }
  }

  /// Where passes that were drawn together still leave a cusp that is too high, one more pass.
  void close_gaps(Chain& chain) const {
    for (int round = 0; round < 3; ++round)
      if (!close_gaps_once(chain)) return;
  }
  [[nodiscard]] bool close_gaps_once(Chain& chain) const {
    const auto high = cusps_above(chain, 1);
    Chain closed;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      closed.push_back(chain[i]);
      if (i + 1 == chain.size() || high[i].empty()) continue;
      closed.push_back([a = chain[i], b = chain[i + 1]](double r) { return 0.5 * (a(r) + b(r)); });
    }
    const bool grown = closed.size() > chain.size();
    chain = std::move(closed);
    return grown;
  }

  /// Asks for a pass; `make_passes` makes all of them. What the curves refer to must live until then.
  void add_pass(Place sigma, bool plus, double r_low = -INFINITY, double r_high = INFINITY) {
    asked_.push_back({std::move(sigma), {}, plus, r_low, r_high});
  }
  /// Along a corner: the ball touches at `sigma` and at `other`.
  void add_corner_pass(Place sigma, Place other, bool plus, double r_low, double r_high) {
    asked_.push_back({std::move(sigma), std::move(other), plus, r_low, r_high});
  }
  /// On all threads; kept in the order in which they were asked for.
  Status make_passes() {
    std::vector<std::optional<Result<SheetPass>>> made(asked_.size());
    tbb::parallel_for(std::size_t(0), made.size(),
                      [&](std::size_t k) { made[k] = make_sheet_pass(sheet_, o_, asked_[k]); });
    for (auto& pass : made) {
      if (!*pass) return pass->error();
      out_.worst_chord_mm = std::max(out_.worst_chord_mm, (*pass)->worst_chord_mm);
      if ((*pass)->pass.points.size() > 1) out_.passes.push_back(std::move((*pass)->pass));
    }
    return Ok{};
  }

  /// Where the ball touches two walls of a corner at once. The plus corner lies on the plus side of the root land, the
  /// minus corner on the other; where the ball does not reach the root land at all they are one.
  struct CornerPlace {
    double from = 0, to = 0;
    bool one = false;  ///< both corners in one
  };
  static std::optional<CornerPlace> find_corner(const std::vector<tooth_space::SheetGap>& gaps, bool plus) {
    for (const auto& g : gaps) {
      const tooth_space::SheetCorner which = tooth_space::corner_of(g);
      if (which == tooth_space::SheetCorner::both ||
          which == (plus ? tooth_space::SheetCorner::plus : tooth_space::SheetCorner::minus))
        return CornerPlace{g.from, g.to, which == tooth_space::SheetCorner::both};
    }
    return {};
  }
  /// Where a corner was seen at the station nearest to r: stands for it where it is not there.
  [[nodiscard]] CornerPlace nearest_corner(double r, bool plus) const {
    double best = INFINITY;
    CornerPlace place{plus ? kRootBegin : kRootEnd, plus ? kRootBegin : kRootEnd, false};
    for (const auto& s : sheet_.stations())
      if (const auto c = find_corner(s.gaps, plus); c && !c->one && std::abs(s.r - r) < best) {
        best = std::abs(s.r - r);
        place.from = place.to = 0.5 * (c->from + c->to);
      }
    return place;
  }
  /// The corner at any radius. Between two stations of which one has none it is on the straight line between its places
  /// there: next to where it opens, both walls cross so flatly that its own place jumps.
  [[nodiscard]] CornerPlace corner_at(double r, bool plus) const {
    const auto& stations = sheet_.stations();
    const double t = std::clamp(station_coordinate(r), 0.0, double(stations.size() - 1));
    const std::size_t j = std::min(std::size_t(t), stations.size() - 2);
    const auto before = find_corner(stations[j].gaps, plus), after = find_corner(stations[j + 1].gaps, plus);
    if (before && after)
      if (const auto c = find_corner(sheet_.gaps(r), plus)) return *c;
    const CornerPlace a = before ? *before : nearest_corner(stations[j].r, plus),
                      b = after ? *after : nearest_corner(stations[j + 1].r, plus);
    const double y = t - double(j);
    return {(1 - y) * a.from + y * b.from, (1 - y) * a.to + y * b.to, y < 0.5 ? a.one : b.one};
  }

  /// Both corners at every station.
  struct Corners {
    std::vector<CornerPlace> plus, minus;
  };
  /// The passes of the plus flank and of the minus flank, each from its tip down to its corner, which is the last one.
  [[nodiscard]] std::vector<Chain> chains_to_corners(const Corners& corners) const {
    const std::size_t n = sheet_.stations().size();
    const auto& totals = count_.totals();
    std::vector<double> begin_a(n), begin_c(n), a(n),
        c(n);  // counts from where a flank's own passes begin to its corner
    for (std::size_t j = 0; j < n; ++j) {
      begin_a[j] = count_.count_at(j, std::min(first_sigma(), corners.plus[j].from));
      begin_c[j] = totals[j] - count_.count_at(j, std::max(5 - first_sigma(), corners.minus[j].to));
      a[j] = count_.count_at(j, last_sigma(corners.plus[j].from)) - begin_a[j];
      c[j] = totals[j] - count_.count_at(j, 5 - last_sigma(5 - corners.minus[j].to)) - begin_c[j];
    }
    // The corner's own pass is the last one. Where the fillet is left out, those of the flank end at the fillet line,
    // half a step from what cuts the fillet.
    const double end = o_.regions[path::Region::fillet] ? 0.5 : 0;
    const auto passes = [&](const std::vector<double>& counts) {
      const double most = most_on_ring(counts);
      return most <= 0 ? 0 : std::max(1, int(std::ceil(most - end - 1e-9 * (end == 0))));
    };
    const int passes_a = passes(a), passes_c = passes(c);
    std::vector<Chain> chains(2);
    Chain &on_plus = chains[0], &on_minus = chains[1];
    for (int i = 0; i < passes_a; ++i) {
      const double share = (i + 0.5) / (passes_a + end);
      std::vector<double> sigma(n);
      for (std::size_t j = 0; j < n; ++j) sigma[j] = count_.sigma_at(j, begin_a[j] + share * a[j]);
      on_plus.push_back(beside_corner(std::move(sigma), share, corners.plus, true));
    }
    for (int i = 0; i < passes_c; ++i) {
      const double share = (i + 0.5) / (passes_c + end);
      std::vector<double> sigma(n);
      for (std::size_t j = 0; j < n; ++j) sigma[j] = count_.sigma_at(j, totals[j] - begin_c[j] - share * c[j]);
      on_minus.push_back(beside_corner(std::move(sigma), share, corners.minus, false));
    }
    if (to_corner()) {
      on_plus.push_back([this](double r) { return corner_at(r, true).from; });
      on_minus.push_back([this](double r) { return corner_at(r, false).to; });
    }
    return chains;
  }
  /// Where the passes of a flank begin, from its tip, and where they end: at the corner, or at the fillet line where
  /// the fillet is left out.
  [[nodiscard]] double first_sigma() const {
    return o_.regions[path::Region::flank] ? 0 : o_.regions[path::Region::fillet] ? 1 : kRootBegin;
  }
  [[nodiscard]] bool to_corner() const { return o_.regions[path::Region::fillet] || o_.regions[path::Region::root]; }
  [[nodiscard]] double last_sigma(double corner) const {
    return o_.regions[path::Region::fillet] ? corner : std::min(corner, 1.0);
  }

  /// A pass of a flank, smooth through its places at the stations. Between them the corner may leave the smooth curve
  /// through its own places: the passes follow it by their share of the way from tip to corner, so that they keep their
  /// distances.
  [[nodiscard]] Place beside_corner(std::vector<double> sigma, double share, const std::vector<CornerPlace>& corner,
                                    bool plus) const {
    std::vector<double> edge;
    for (const auto& c : corner) edge.push_back(plus ? c.from : c.to);
    return [this, sigma = std::move(sigma), share, edge = std::move(edge), plus](double r) {
      const double t = station_coordinate(r);
      const CornerPlace c = corner_at(r, plus);
      return smooth(sigma, t) + share * ((plus ? c.from : c.to) - smooth(edge, t));
    };
  }

  /// With corners: each flank has its own passes down to its corner, one pass follows every corner, and where the ball
  /// reaches the root land its passes lie between the corners. No pass crosses a corner.
  void passes_between_corners() {
    Corners corners;
    for (const auto& station : sheet_.stations()) {
      corners.plus.push_back(corner_at(station.r, true));
      corners.minus.push_back(corner_at(station.r, false));
    }
    auto chains = drawn_together([&] { return chains_to_corners(corners); });
    Chain &on_plus = chains[0], &on_minus = chains[1];
    note_cusps(on_plus);
    note_cusps(on_minus);
    if (to_corner()) on_minus.pop_back();  // the minus corner comes below, where it is apart from the plus corner
    for (std::size_t i = 0; i < std::max(on_plus.size(), on_minus.size()); ++i) {
      if (to_corner() && i + 1 == on_plus.size())  // along the corner
        add_corner_pass(
            on_plus[i], [this](double r) { return corner_at(r, true).to; }, true, -INFINITY, INFINITY);
      else if (i < on_plus.size()) add_pass(on_plus[i], true);
      if (i < on_minus.size()) add_pass(on_minus[i], false);
    }
    out_.corner_passes = to_corner();
    if (to_corner()) passes_on_root_land(corners);
  }

  /// From corner to corner over the root land, both of them included; where the corners are one, that one.
  [[nodiscard]] Chain land_chain(int between) const {
    Chain land;
    for (int i = 0; i <= between; ++i)
      land.push_back([this, i, between](double r) {
        const CornerPlace p = corner_at(r, true), m = corner_at(r, false);
        if (p.one) return p.from;
        return p.to + (m.from - p.to) * i / std::max(between, 1);
      });
    return land;
  }

  /// The minus corner and the root land, over every stretch where they are apart from the plus corner.
  void passes_on_root_land(const Corners& corners) {
    const auto& stations = sheet_.stations();
    const std::size_t n = stations.size();
    for (std::size_t j = 0; j < n;) {
      if (corners.plus[j].one) {
        ++j;
        continue;
      }
      std::size_t end = j;
      while (end + 1 < n && !corners.plus[end + 1].one) ++end;
      const double r_low = j > 0 ? stations[j - 1].r : -INFINITY, r_high = end + 1 < n ? stations[end + 1].r : INFINITY;
      add_corner_pass([this](double r) { return corner_at(r, false).to; },
                      [this](double r) { return corner_at(r, false).from; }, false, r_low, r_high);
      double most = 0;
      for (std::size_t k = j; k <= end; ++k)
        most = std::max(most, count_.count_at(k, corners.minus[k].from) - count_.count_at(k, corners.plus[k].to));
      int between = int(std::ceil(most - 1e-9));
      Chain land = land_chain(between);
      for (int round = 0; round < kDrawRounds && !high_cusps(land).empty(); ++round) land = land_chain(++between);
      note_cusps(land);
      for (int i = 1; i < between; ++i) add_pass(land[std::size_t(i)], 2 * i < between, r_low, r_high);
      j = end + 1;
    }
  }

  [[nodiscard]] double station_coordinate(double r) const {
    return (r - sheet_.r_from()) / (sheet_.r_to() - sheet_.r_from()) * double(sheet_.stations().size() - 1);
  }

  const tooth_space::OffsetSheet& sheet_;
  FinishingOptions o_;
  PassCount count_;
  std::vector<SheetPassAsked> asked_;
  FinishingPasses out_;
};

}  // namespace

Result<FinishingPasses> plan_finishing(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options) {
  const auto& ring = sheet.space().outline();
  if (sheet.empty() || sheet.r_from() >= sheet.r_to()) {
    const auto [from, to] = ring.told(ring.s_from, ring.s_to);
    return fail("the ball centres of a {:.4f} mm ball find no surface between {} {:.4f} and {:.4f} mm",
                options.ball_radius_mm, ring.along, from, to);
  }
  return FinishingPlanner(sheet, options).run();
}

}  // namespace toothpath::ball
