#include "cam/finishing.h"

#include <algorithm>
#include <cmath>

namespace toothpath {
namespace {

/// The curvature jumps where fillets meet flanks and root land, and a cusp that spans the jump is higher than its step
/// says: in the corners passes aim at this share of the asked cusp.
constexpr double kCornerShare = 0.7;

double radius(const Vec3& p) { return std::hypot(p.x(), p.y()); }

/// Passes counted along one profile: `count` grows by one from pass to pass.
struct CountedProfile {
  std::vector<double> sigma, count;  ///< same length, both ascending; gaps are jumps in sigma at equal count
  double flank_end_plus = 0, flank_end_minus = 0;  ///< count where the flanks meet the fillets
};

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto it = std::upper_bound(x.begin(), x.end(), at);
  if (it == x.begin()) return y.front();
  if (it == x.end()) return y.back();
  const auto k = std::size_t(it - x.begin());
  const double t = x[k] > x[k - 1] ? (at - x[k - 1]) / (x[k] - x[k - 1]) : 0;
  return y[k - 1] + t * (y[k] - y[k - 1]);
}

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

class Planner {
 public:
  Planner(const OffsetSheet& sheet, const FinishingOptions& options) : sheet_(sheet), o_(options) {}

  Result<FinishingPasses> run() {
    const auto& ring = sheet_.space().ring().zone;
    if (sheet_.empty() || sheet_.r_from() >= sheet_.r_to())
      return fail("the ball centres of a {:.4f} mm ball find no surface between the radii {:.4f} and {:.4f}",
                  o_.ball_radius_mm, ring.inner_radius_mm, ring.outer_radius_mm);
    count_profiles();
    const double most = *std::max_element(totals_.begin(), totals_.end());
    const int passes = std::max(2, int(std::ceil(most - 1e-9)));
    out_.scallop_min_mm = INFINITY;
    for (double total : totals_) {
      const double h = o_.scallop_mm * (total / passes) * (total / passes);
      out_.scallop_min_mm = std::min(out_.scallop_min_mm, h);
      out_.scallop_max_mm = std::max(out_.scallop_max_mm, h);
    }
    // From both tips downwards, in turn, so that a climbing pass on one flank leads to a climbing pass on the other.
    std::vector<int> order;
    for (int a = 0, b = passes - 1; a <= b; ++a, --b) {
      order.push_back(a);
      if (b != a) order.push_back(b);
    }
    for (int index : order) {
      const double share = (index + 0.5) / passes;
      std::vector<double> sigma;
      for (std::size_t j = 0; j < profiles_.size(); ++j)
        sigma.push_back(interpolate(profiles_[j].count, profiles_[j].sigma, share * totals_[j]));
      const auto pass = make_pass([&](double r) { return smooth(sigma, station_coordinate(r)); }, share < 0.5);
      if (!pass) return pass.error();
      if (!pass->points.empty()) out_.passes.push_back(std::move(*pass));
    }
    if (sheet_.has_gaps()) {
      if (auto ok = corner_passes(); !ok) return ok.error();
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] double station_coordinate(double r) const {
    return (r - sheet_.r_from()) / (sheet_.r_to() - sheet_.r_from()) * double(profiles_.size() - 1);
  }

  /// Centre spacing across the pass for the asked cusp at a contact point.
  [[nodiscard]] double spacing(const SheetPoint& s, const Vec3& feed) const {
    const Vec3 across = s.contact.n.cross(feed);
    const double k = SpaceSheet::normal_curvature(s.contact, across);
    const double regular = std::max(1e-6, (1 + k * sheet_.delta()) / (1 + k * o_.allowance_mm));
    const bool corner = s.piece != SpacePiece::flank_plus && s.piece != SpacePiece::flank_minus;
    return std::sqrt(8 * (corner ? kCornerShare : 1.0) * o_.scallop_mm * o_.ball_radius_mm * regular);
  }

  void count_profiles() {
    const auto& stations = sheet_.stations();
    const std::size_t n = stations.size();
    // Direction of the passes: first along constant sigma, then along constant share of the count.
    for (int round = 0; round < 2; ++round) {
      std::vector<CountedProfile> profiles(n);
      std::vector<double> totals(n);
      for (std::size_t j = 0; j < n; ++j) {
        const auto& st = stations[j];
        CountedProfile p;
        double count = 0;
        const OffsetSheet::Node* previous = nullptr;
        double previous_w = 0;
        Vec3 previous_feed = Vec3::Zero();
        for (std::size_t k = 0; k < st.nodes.size(); ++k) {
          const auto& node = st.nodes[k];
          const bool hidden = std::any_of(st.gaps.begin(), st.gaps.end(), [&](const SheetGap& g) {
            return node.sigma > g.from && node.sigma < g.to;
          });
          if (hidden) continue;
          const Vec3 feed = feed_direction(j, k, round);
          const double w = spacing(node.at, feed);
          if (previous) {
            const Vec3 step = node.at.centre - previous->at.centre;
            const Vec3 mean_feed = (feed + previous_feed).normalized();
            count += step.cross(mean_feed).norm() / (0.5 * (w + previous_w));
          }
          p.sigma.push_back(node.sigma);
          p.count.push_back(count);
          previous = &node;
          previous_w = w;
          previous_feed = feed;
        }
        p.flank_end_plus = interpolate(p.sigma, p.count, 1.0);
        p.flank_end_minus = interpolate(p.sigma, p.count, 4.0);
        totals[j] = count;
        profiles[j] = std::move(p);
      }
      profiles_ = std::move(profiles);
      totals_ = std::move(totals);
    }
  }

  [[nodiscard]] Vec3 feed_direction(std::size_t j, std::size_t k, int round) const {
    const auto& stations = sheet_.stations();
    const std::size_t a = j > 0 ? j - 1 : j, b = j + 1 < stations.size() ? j + 1 : j;
    const auto place = [&](std::size_t s) -> Vec3 {
      if (round == 0 || profiles_.empty()) return stations[s].nodes[k].at.centre;
      const double share = interpolate(profiles_[j].sigma, profiles_[j].count, stations[j].nodes[k].sigma) / totals_[j];
      const double sigma = interpolate(profiles_[s].count, profiles_[s].sigma, share * totals_[s]);
      const auto q = sheet_.at(sigma, stations[s].r);
      return q ? q->centre : stations[s].nodes[k].at.centre;
    };
    return (place(b) - place(a)).normalized();
  }

  /// The piece of the curve whose contact lies on the ring, with the run-out at both ends.
  template <typename Sigma>
  Result<BallPass> make_pass(const Sigma& sigma, bool plus, double r_low = -INFINITY, double r_high = INFINITY) {
    const auto& ring = sheet_.space().ring().zone;
    const auto contact_radius = [&](double r) -> double {
      const auto s = sheet_.at(sigma(r), r);
      return s ? radius(s->contact.p) : NAN;
    };
    const auto solve = [&](double target) -> double {
      double a = sheet_.r_from(), b = sheet_.r_to();
      if (contact_radius(a) > target || contact_radius(b) < target) return NAN;
      for (int k = 0; k < 60 && b - a > 1e-9; ++k) {
        const double m = 0.5 * (a + b);
        (contact_radius(m) < target ? a : b) = m;
      }
      return 0.5 * (a + b);
    };
    const double from = solve(ring.inner_radius_mm), to = solve(ring.outer_radius_mm);
    if (std::isnan(from) || std::isnan(to))
      return fail("the flank ends inside the ring: ball centres reach contact radii {:.4f} to {:.4f}, the ring is "
                  "{:.4f} to {:.4f}",
                  contact_radius(sheet_.r_from()), contact_radius(sheet_.r_to()), ring.inner_radius_mm,
                  ring.outer_radius_mm);
    // A corner that begins or ends inside the ring: the pass is as long as the corner.
    const double begin = std::max(from, r_low), end = std::min(to, r_high);
    if (!(end > begin)) return BallPass{};
    const auto on_sheet = [&](double r) -> std::optional<BallPass::Point> {
      const auto s = sheet_.at(sigma(r), r);
      if (!s) return {};
      return BallPass::Point{s->centre, s->contact.p, true};
    };
    const auto curve = sample_curve(on_sheet, begin, end, o_.chord_mm, 4.0 * o_.ball_radius_mm);
    if (!curve) return fail("the ball-centre surface cannot be followed between radii {:.4f} and {:.4f}", from, to);
    out_.worst_chord_mm = std::max(out_.worst_chord_mm, curve->worst_chord_mm);
    BallPass pass;
    pass.points = curve->points;
    add_run_out(pass, sigma, from, to, begin == from, end == to);
    pass.outward = plus == o_.climb;
    if (!pass.outward) std::reverse(pass.points.begin(), pass.points.end());
    return pass;
  }

  /// Goes on tangentially beyond both ends: along the sheet as far as it is there, then straight.
  template <typename Sigma>
  void add_run_out(BallPass& pass, const Sigma& sigma, double from, double to, bool inside, bool outside) const {
    const auto extend = [&](double end, double sense) {
      const double step = 1e-4;
      const auto a = sheet_.at(sigma(end), end), b = sheet_.at(sigma(end - sense * step), end - sense * step);
      BallPass::Point p;
      p.touching = false;
      const double target = end + sense * o_.run_out_mm;
      if (target >= sheet_.r_from() && target <= sheet_.r_to()) {
        if (const auto s = sheet_.at(sigma(target), target)) {
          // Straight to a point of the sheet would sag into a hollow-free side only; lift over the middle is not needed
          // as long as the sheet bends less than the ball: the ring ends before the chord does.
          p.centre = s->centre;
          p.contact = s->contact.p;
          return p;
        }
      }
      const Vec3 tangent = (a->centre - b->centre).normalized();
      const double rate = std::abs(radius(a->centre + tangent * 1e-3) - radius(a->centre)) / 1e-3;
      p.centre = a->centre + tangent * (o_.run_out_mm / std::max(rate, 0.2));
      p.contact = a->contact.p;
      return p;
    };
    if (inside) pass.points.insert(pass.points.begin(), extend(from, -1));
    if (outside) pass.points.push_back(extend(to, 1));
  }

  /// Where the ball touches two walls of a corner at once: passes along the corners, as far as the corners are there.
  Status corner_passes() {
    const auto& stations = sheet_.stations();
    const auto find = [](const std::vector<SheetGap>& gaps, bool plus) -> const SheetGap* {
      for (const auto& g : gaps)
        if (plus ? g.from < 2.5 : g.from > 2.5) return &g;  // one crossing that spans the root counts as the plus corner
      return nullptr;
    };
    for (const bool plus : {true, false}) {
      std::size_t j = 0;
      while (j < stations.size()) {
        if (!find(stations[j].gaps, plus)) {
          ++j;
          continue;
        }
        std::size_t end = j;
        while (end + 1 < stations.size() && find(stations[end + 1].gaps, plus)) ++end;
        if (end > j) {
          const auto sigma = [&](double r) {
            const auto gaps = sheet_.gaps(r);
            const auto* g = find(gaps, plus);
            return g ? g->from : (plus ? 2.0 : 3.0);
          };
          const auto pass = make_pass(sigma, plus, stations[j].r, stations[end].r);
          if (!pass) return pass.error();
          if (pass->points.size() > 1) out_.passes.push_back(*pass);
          out_.corner_passes = true;
        }
        j = end + 1;
      }
    }
    return Ok{};
  }

  const OffsetSheet& sheet_;
  FinishingOptions o_;
  std::vector<CountedProfile> profiles_;
  std::vector<double> totals_;
  FinishingPasses out_;
};

}  // namespace

Result<FinishingPasses> plan_finishing(const OffsetSheet& sheet, const FinishingOptions& options) {
  return Planner(sheet, options).run();
}

}  // namespace toothpath
