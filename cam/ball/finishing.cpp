#include "cam/ball/finishing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <type_traits>

#include "cam/ball/pass_count.h"

namespace toothpath::ball {
namespace {

constexpr double kLongestRunOut = 1.5;  // way of a run-out along the sheet, of the straight line between its ends
constexpr double kRootBegin = 2, kRootEnd = 3;  // the root land on the sheet; below it plus fillet and flank, above it minus
constexpr double kHighestCusp = 1.1;  // a cusp above this share of the asked one gets a pass of its own


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
  FinishingPlanner(const face_gear::OffsetSheet& sheet, const FinishingOptions& options) : sheet_(sheet), o_(options), count_(sheet, options) {}

  Result<FinishingPasses> run() {
    out_.scallop_min_mm = INFINITY;
    if (sheet_.has_gaps()) passes_between_corners();
    else passes_over_all();
    if (auto ok = make_passes(); !ok) return ok.error();
    return std::move(out_);
  }

 private:
  struct MadePass {
    BallPass pass;
    double worst_chord_mm = 0;
  };

  /// The whole sheet as one: from both tips downwards, in turn, so that a climbing pass on one flank leads to a climbing pass
  /// on the other. (Counts of single flanks vary more along the tooth than the count of the whole space does.)
  void passes_over_all() {
    const auto& totals = count_.totals();
    const double most = *std::max_element(totals.begin(), totals.end());
    const int passes = std::max(2, int(std::ceil(most - 1e-9)));
    note_scallop(totals, passes);
    Chain chain;
    for (int index = 0; index < passes; ++index) {
      const double share = (index + 0.5) / passes;
      std::vector<double> sigma;
      for (std::size_t j = 0; j < totals.size(); ++j) sigma.push_back(count_.sigma_at(j, share * totals[j]));
      chain.push_back([this, sigma](double r) { return smooth(sigma, station_coordinate(r)); });
    }
    close_gaps(chain);
    const std::size_t all = chain.size(), on_plus = passes_of_plus(chain);
    for (std::size_t i = 0; i < std::max(on_plus, all - on_plus); ++i) {
      if (i < on_plus) add_pass(chain[i], true);
      if (i < all - on_plus) add_pass(chain[all - 1 - i], false);
    }
  }

  /// Neighbouring passes, each as sigma over the centre radius.
  using Chain = std::vector<std::function<double(double)>>;

  /// How many passes of the chain are fed as those of the plus flank: none that touches the minus fillet, and all that touch the plus fillet
  /// or flank, so that material lies on the asked side of every one. The root land takes either feed: there the middle of the chain divides.
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

  /// Looks at every cusp between the final passes, also between the stations, and puts one more pass where it is too high.
  void close_gaps(Chain& chain) const {
    for (int round = 0; round < 3; ++round)
      if (!close_gaps_once(chain)) return;
  }
  [[nodiscard]] bool close_gaps_once(Chain& chain) const {
    std::vector<char> add(chain.size(), 0);
    tbb::parallel_for(std::size_t(0), chain.size() - 1, [&](std::size_t i) { add[i] = too_far_apart(chain[i], chain[i + 1]); });
    Chain closed;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      closed.push_back(chain[i]);
      if (!add[i]) continue;
      closed.push_back([this, a = chain[i], b = chain[i + 1]](double r) { return 0.5 * (a(r) + b(r)); });
    }
    const bool grown = closed.size() > chain.size();
    chain = std::move(closed);
    return grown;
  }

  [[nodiscard]] bool too_far_apart(const std::function<double(double)>& a, const std::function<double(double)>& b) const {
    const double low = sheet_.r_from(), high = sheet_.r_to();
    const int samples = 2 * int(sheet_.stations().size());
    const double step = 1e-3 * (high - low);
    for (int k = 1; k < samples; ++k) {
      const double r = low + (high - low) * k / samples;
      const double sigma_a = a(r), sigma_b = b(r);
      const bool flat = std::max(sigma_a, sigma_b) < 0.9 || std::min(sigma_a, sigma_b) > 4.1;
      if (flat && k % 4 != 0) continue;  // the flanks bend slowly
      const auto pa = sheet_.at(sigma_a, r), pb = sheet_.at(sigma_b, r);
      const auto na = sheet_.at(a(r + step), r + step), nb = sheet_.at(b(r + step), r + step);
      if (!pa || !pb || !na || !nb) continue;
      const double ra = radius(pa->contact.p);
      const auto& ring = sheet_.space().ring().zone;
      if (ra < ring.inner_radius_mm - o_.ball_radius_mm || ra > ring.outer_radius_mm + o_.ball_radius_mm) continue;
      const PassPlace lower{sigma_a, *pa, (na->centre - pa->centre).normalized()}, upper{sigma_b, *pb, (nb->centre - pb->centre).normalized()};
      if (count_.cusp(lower, upper, r, sheet_.gaps(r)) > kHighestCusp * o_.scallop_mm) return true;
    }
    return false;
  }

  void note_scallop(const std::vector<double>& totals, double passes) {
    for (double total : totals) {
      const double h = o_.scallop_mm * (total / passes) * (total / passes);
      out_.scallop_min_mm = std::min(out_.scallop_min_mm, h);
      out_.scallop_max_mm = std::max(out_.scallop_max_mm, h);
    }
  }

  /// Asks for a pass; `make_passes` makes all of them. What the curves refer to must live until then.
  template <typename Sigma>
  void add_pass(const Sigma& sigma, bool plus, double r_low = -INFINITY, double r_high = INFINITY) {
    asked_.push_back([=, this] { return make_pass(sigma, sigma, plus, r_low, r_high); });
  }
  /// Along a corner: the ball touches at `sigma` and at `other`, and the pass is as long as either of the two contacts lies on the ring.
  template <typename Sigma, typename Other>
  void add_pass(const Sigma& sigma, const Other& other, bool plus, double r_low, double r_high) {
    asked_.push_back([=, this] { return make_pass(sigma, other, plus, r_low, r_high); });
  }
  /// On all threads; kept in the order in which they were asked for.
  Status make_passes() {
    std::vector<std::optional<Result<MadePass>>> made(asked_.size());
    tbb::parallel_for(std::size_t(0), made.size(), [&](std::size_t k) { made[k] = asked_[k](); });
    for (auto& pass : made) {
      if (!*pass) return pass->error();
      out_.worst_chord_mm = std::max(out_.worst_chord_mm, (*pass)->worst_chord_mm);
      if ((*pass)->pass.points.size() > 1) out_.passes.push_back(std::move((*pass)->pass));
    }
    return Ok{};
  }

  /// Where the ball touches two walls of a corner at once. The plus corner lies on the plus side of the root land, the minus
  /// corner on the other; where the ball does not reach the root land at all they are one.
  struct CornerPlace {
    double from = 0, to = 0;
    bool one = false;  ///< both corners in one
  };
  static std::optional<CornerPlace> find_corner(const std::vector<face_gear::SheetGap>& gaps, bool plus) {
    for (const auto& g : gaps) {
      const face_gear::SheetCorner which = face_gear::corner_of(g);
      if (which == face_gear::SheetCorner::both || which == (plus ? face_gear::SheetCorner::plus : face_gear::SheetCorner::minus)) return CornerPlace{g.from, g.to, which == face_gear::SheetCorner::both};
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
  /// The corner at any radius. Between two stations of which one has none it is on the straight line between its places there: next to
  /// where it opens, both walls cross so flatly that its own place jumps.
  [[nodiscard]] CornerPlace corner_at(double r, bool plus) const {
    const auto& stations = sheet_.stations();
    const double t = std::clamp(station_coordinate(r), 0.0, double(stations.size() - 1));
    const std::size_t j = std::min(std::size_t(t), stations.size() - 2);
    const auto before = find_corner(stations[j].gaps, plus), after = find_corner(stations[j + 1].gaps, plus);
    if (before && after)
      if (const auto c = find_corner(sheet_.gaps(r), plus)) return *c;
    const CornerPlace a = before ? *before : nearest_corner(stations[j].r, plus), b = after ? *after : nearest_corner(stations[j + 1].r, plus);
    const double y = t - double(j);
    return {(1 - y) * a.from + y * b.from, (1 - y) * a.to + y * b.to, y < 0.5 ? a.one : b.one};
  }

  /// With corners: each flank has its own passes down to its corner, one pass follows every corner, and where the ball reaches
  /// the root land its passes lie between the corners. No pass crosses a corner.
  void passes_between_corners() {
    const auto& stations = sheet_.stations();
    const std::size_t n = stations.size();
    std::vector<CornerPlace> plus(n), minus(n);
    for (std::size_t j = 0; j < n; ++j) {
      plus[j] = corner_at(stations[j].r, true);
      minus[j] = corner_at(stations[j].r, false);
    }
    const auto& totals = count_.totals();
    std::vector<double> a(n), c(n);  // counts of the plus flank and of the minus flank, tip to corner
    for (std::size_t j = 0; j < n; ++j) {
      a[j] = count_.count_at(j, plus[j].from);
      c[j] = totals[j] - count_.count_at(j, minus[j].to);
    }
    const int passes_a = std::max(1, int(std::ceil(*std::max_element(a.begin(), a.end()) - 0.5)));
    const int passes_c = std::max(1, int(std::ceil(*std::max_element(c.begin(), c.end()) - 0.5)));
    note_scallop(a, passes_a + 0.5);
    note_scallop(c, passes_c + 0.5);
    // Distances from the corner are smooth along the tooth, also where the corner itself moves.
    Chain on_plus, on_minus;
    for (int i = 0; i < passes_a; ++i) {
      std::vector<double> away(n);
      for (std::size_t j = 0; j < n; ++j) away[j] = plus[j].from - count_.sigma_at(j, (i + 0.5) / (passes_a + 0.5) * a[j]);
      on_plus.push_back([this, away](double r) { return corner_at(r, true).from - smooth(away, station_coordinate(r)); });
    }
    for (int i = 0; i < passes_c; ++i) {
      std::vector<double> away(n);
      for (std::size_t j = 0; j < n; ++j) away[j] = count_.sigma_at(j, totals[j] - (i + 0.5) / (passes_c + 0.5) * c[j]) - minus[j].to;
      on_minus.push_back([this, away](double r) { return corner_at(r, false).to + smooth(away, station_coordinate(r)); });
    }
    on_plus.push_back([this](double r) { return corner_at(r, true).from; });
    on_minus.push_back([this](double r) { return corner_at(r, false).to; });
    close_gaps(on_plus);
    close_gaps(on_minus);
    on_minus.pop_back();  // the minus corner comes below, where it is apart from the plus corner
    for (std::size_t i = 0; i < std::max(on_plus.size(), on_minus.size()); ++i) {
      if (i + 1 == on_plus.size())  // along the corner
        add_pass(on_plus[i], [this](double r) { return corner_at(r, true).to; }, true, -INFINITY, INFINITY);
      else if (i < on_plus.size())
        add_pass(on_plus[i], true);
      if (i < on_minus.size()) add_pass(on_minus[i], false);
    }
    out_.corner_passes = true;
    passes_of_root_land(plus, minus);
  }

  /// The minus corner and the root land, over every stretch where they are apart from the plus corner; `plus`, `minus`: at the stations.
  void passes_of_root_land(const std::vector<CornerPlace>& plus, const std::vector<CornerPlace>& minus) {
    const auto& stations = sheet_.stations();
    const std::size_t n = stations.size();
    for (std::size_t j = 0; j < n;) {
      if (plus[j].one) {
        ++j;
        continue;
      }
      std::size_t end = j;
      while (end + 1 < n && !plus[end + 1].one) ++end;
      const double r_low = j > 0 ? stations[j - 1].r : -INFINITY, r_high = end + 1 < n ? stations[end + 1].r : INFINITY;
      add_pass([this](double r) { return corner_at(r, false).to; }, [this](double r) { return corner_at(r, false).from; }, false, r_low, r_high);
      double most = 0;
      for (std::size_t k = j; k <= end; ++k) most = std::max(most, count_.count_at(k, minus[k].from) - count_.count_at(k, plus[k].to));
      const int between = int(std::ceil(most - 1e-9));
      for (int i = 1; i < between; ++i) {
        const auto sigma = [this, i, between](double r) {
          const CornerPlace p = corner_at(r, true), m = corner_at(r, false);
          if (p.one) return p.from;
          return p.to + (m.from - p.to) * i / between;
        };
        add_pass(sigma, 2 * i < between, r_low, r_high);
      }
      j = end + 1;
    }
  }

  [[nodiscard]] double station_coordinate(double r) const {
    return (r - sheet_.r_from()) / (sheet_.r_to() - sheet_.r_from()) * double(sheet_.stations().size() - 1);
  }

  /// The piece of the curve whose contact (one of the two, along a corner) lies on the ring, with the run-out at both ends.
  template <typename Sigma, typename Other>
  Result<MadePass> make_pass(const Sigma& sigma, const Other& other, bool plus, double r_low, double r_high) const {
    const auto& ring = sheet_.space().ring().zone;
    const auto contact_radius = [&](double at, double r) -> double {
      const auto s = sheet_.at(at, r);
      return s ? radius(s->contact.p) : NAN;
    };
    const auto solve = [&](const auto& curve, double target) -> double {
      double a = sheet_.r_from(), b = sheet_.r_to();
      if (contact_radius(curve(a), a) > target || contact_radius(curve(b), b) < target) return NAN;
      for (int k = 0; k < 60 && b - a > 1e-9; ++k) {
        const double m = 0.5 * (a + b);
        (contact_radius(curve(m), m) < target ? a : b) = m;
      }
      return 0.5 * (a + b);
    };
    double from = solve(sigma, ring.inner_radius_mm), to = solve(sigma, ring.outer_radius_mm);
    if constexpr (!std::is_same_v<Sigma, Other>) {
      from = std::min(from, solve(other, ring.inner_radius_mm));
      to = std::max(to, solve(other, ring.outer_radius_mm));
    }
    if (std::isnan(from) || std::isnan(to))
      return fail("the flank ends inside the ring: ball centres reach contact radii {:.4f} to {:.4f}, the ring is "
                  "{:.4f} to {:.4f}",
                  contact_radius(sigma(sheet_.r_from()), sheet_.r_from()), contact_radius(sigma(sheet_.r_to()), sheet_.r_to()),
                  ring.inner_radius_mm, ring.outer_radius_mm);
    // A corner that begins or ends inside the ring: the pass is as long as the corner.
    const double begin = std::max(from, r_low), end = std::min(to, r_high);
    if (!(end > begin)) return MadePass{};
    const auto on_sheet = [&](double r) -> std::optional<BallPass::Point> {
      const auto s = sheet_.at(sigma(r), r);
      if (!s) return {};
      return BallPass::Point{s->centre, s->contact.p, true};
    };
    const auto curve = sample_curve(on_sheet, begin, end, o_.chord_mm, 4.0 * o_.ball_radius_mm);
    if (!curve) return fail("the ball-centre surface cannot be followed between radii {:.4f} and {:.4f}", from, to);
    BallPass pass;
    pass.points = curve->points;
    add_run_out(pass, on_sheet, from, to, begin == from, end == to);
    pass.outward = plus == o_.climb;
    if (!pass.outward) std::reverse(pass.points.begin(), pass.points.end());
    return MadePass{std::move(pass), curve->worst_chord_mm};
  }

  /// Not to and fro: its way is that of a curve, not many times the straight line between its ends.
  static bool keeps_on(const std::vector<BallPass::Point>& points) {
    double way = 0;
    for (std::size_t k = 1; k < points.size(); ++k) way += (points[k].centre - points[k - 1].centre).norm();
    return way <= kLongestRunOut * (points.back().centre - points.front().centre).norm();
  }

  /// Goes on beyond the ends of the ring: along the sheet where that is there and smooth, else straight on. Out there the ball may come to
  /// a corner that the ring does not have, and the sheet jumps from one wall of it to the other.
  template <typename Curve>
  void add_run_out(BallPass& pass, const Curve& on_sheet, double from, double to, bool inside, bool outside) const {
    const auto extend = [&](double end, double sense) {
      const double target = std::clamp(end + sense * o_.run_out_mm, sheet_.r_from(), sheet_.r_to());
      std::vector<BallPass::Point> out;
      if (std::abs(target - end) > 0.3 * o_.run_out_mm)
        if (const auto line = sample_curve(on_sheet, end, target, o_.chord_mm, 4.0 * o_.ball_radius_mm); line && keeps_on(line->points)) {
          out.assign(line->points.begin() + 1, line->points.end());
          for (auto& p : out) p.touching = false;
          return out;
        }
      const auto a = on_sheet(end), b = on_sheet(end - sense * 1e-4);
      if (!a || !b) return out;
      const Vec3 tangent = (a->centre - b->centre).normalized();
      const double rate = std::abs(radius(a->centre + tangent * 1e-3) - radius(a->centre)) / 1e-3;
      out.push_back({a->centre + tangent * (o_.run_out_mm / std::max(rate, 0.2)), a->contact, false});
      return out;
    };
    if (inside) {
      const auto points = extend(from, -1);
      pass.points.insert(pass.points.begin(), points.rbegin(), points.rend());
    }
    if (outside) {
      const auto points = extend(to, 1);
      pass.points.insert(pass.points.end(), points.begin(), points.end());
    }
  }

  const face_gear::OffsetSheet& sheet_;
  FinishingOptions o_;
  PassCount count_;
  std::vector<std::function<Result<MadePass>()>> asked_;
  FinishingPasses out_;
};

}  // namespace

Result<FinishingPasses> plan_finishing(const face_gear::OffsetSheet& sheet, const FinishingOptions& options) {
  const auto& ring = sheet.space().ring().zone;
  if (sheet.empty() || sheet.r_from() >= sheet.r_to())
    return fail("the ball centres of a {:.4f} mm ball find no surface between the radii {:.4f} and {:.4f}",
                options.ball_radius_mm, ring.inner_radius_mm, ring.outer_radius_mm);
  return FinishingPlanner(sheet, options).run();
}

}  // namespace toothpath::ball
