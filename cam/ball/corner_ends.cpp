#include "cam/ball/corner_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toothpath::ball {
namespace {

constexpr double kWallTouch = 5e-5;  // a ball this much into the edge of the other wall still counts as touching it, mm
constexpr double kSearchStep = 0.02;    // in sigma: fiftieths of a fillet
constexpr double kCuspAim = 0.8;        // of the asked cusp
constexpr double kShortestPass = 1e-3;  // a stretch shorter than this needs no pass, mm
constexpr double kFeedStep = 1e-4;      // between two places of a pass, for its direction, mm
constexpr int kMostPasses = 40;         // at one end of one wall
constexpr int kHeightSamples = 48;      // places of a profile at which the height is measured

/// One wall of one corner at one end of the ring.
class OpenEnd {
 public:
  /// `plus`: the corner lies on the plus side of the root land. `upper`: the wall after the gap (in sigma), else the
  /// one before it.
  OpenEnd(const tooth_space::OffsetSheet& sheet, const FinishingOptions& o, const PartDistance& distance, bool inner,
          bool plus, bool upper)
      : sheet_(sheet), o_(o), distance_(distance), inner_(inner), plus_(plus), upper_(upper) {
    const auto& zone = sheet.space().outline();
    end_ = inner ? zone.s_from : zone.s_to;
  }

  std::vector<BallPass> passes() const {
    // s of the centre: where the corner closes, and where the farthest pass leaves the ring.
    const auto closed = solve([&](double r) { return contact_at(other_edge(r), r); });
    const auto opened = solve([&](double r) { return contact_at(place(1, r), r); });
    if (!closed || !opened) return {};
    const double inward = inner_ ? 1 : -1;
    if (inward * (*closed - *opened) < kShortestPass) return {};
    int count = 0;
    while (count < kMostPasses && left_between(count, *opened) > kCuspAim * o_.scallop_mm[path::Region::fillet])
      ++count;
    std::vector<BallPass> out;
    for (int i = 1; i <= count; ++i)
      if (auto pass = make_pass(double(i) / count, *closed)) out.push_back(std::move(*pass));
    return out;
  }

 private:
  [[nodiscard]] std::optional<tooth_space::SheetGap> gap(double r) const {
    for (const auto& g : sheet_.gaps(r)) {
      const tooth_space::SheetCorner which = tooth_space::corner_of(g);
      if (which == tooth_space::SheetCorner::plus || which == tooth_space::SheetCorner::both ? plus_ : !plus_) return g;
    }
    return {};
  }
  /// The end of the gap on this wall, and the one on the other wall; NaN where there is no corner.
  [[nodiscard]] double edge(double r) const {
    const auto g = gap(r);
    return !g ? NAN : upper_ ? g->to : g->from;
  }
  [[nodiscard]] double other_edge(double r) const {
    const auto g = gap(r);
    return !g ? NAN : upper_ ? g->from : g->to;
  }
  [[nodiscard]] double contact_at(double sigma, double r) const {
    if (std::isnan(sigma)) return NAN;
    const auto s = sheet_.raw(sigma, r);
    return s ? sheet_.space().outline().chart.along(s->contact.p) : NAN;
  }
  /// s of the centre at which a contact lies at the end of the ring.
  template <typename Contact>
  [[nodiscard]] std::optional<double> solve(const Contact& contact) const {
    double a = sheet_.r_from(), b = sheet_.r_to();
    if (!(contact(a) < end_) || !(contact(b) > end_)) return {};
    for (int k = 0; k < 60 && b - a > 1e-9; ++k) {
      const double m = 0.5 * (a + b), at = contact(m);
      if (std::isnan(at)) return {};
      (at < end_ ? a : b) = m;
    }
    return 0.5 * (a + b);
  }
  [[nodiscard]] bool clear(double sigma, double r, double touch) const {
    const auto s = sheet_.raw(sigma, r);
    return s && distance_(s->centre) >= sheet_.delta() - touch;
  }
  /// How far past the crossing the ball touches this wall and is free of everything else; the crossing itself where it
  /// is not.
  [[nodiscard]] double reach(double r, double touch) const {
    const auto g = gap(r);
    if (!g) return NAN;
    const double sense = upper_ ? -1 : 1, most = g->to - g->from;
    const double start = upper_ ? g->to : g->from;
    double good = 0, bad = kSearchStep;
    while (bad < most && clear(start + sense * bad, r, touch)) {
      good = bad;
      bad += kSearchStep;
    }
    if (bad >= most) return start + sense * good;
    for (int k = 0; k < 24; ++k) {
      const double m = 0.5 * (good + bad);
      (clear(start + sense * m, r, touch) ? good : bad) = m;
    }
    return start + sense * good;
  }
  /// sigma at a share of the way from the crossing to the reach.
  [[nodiscard]] double place(double share, double r) const {
    return edge(r) + share * (reach(r, kWallTouch) - edge(r));
  }

  /// Highest place past the crossing above what `count` passes and the pass along the corner leave, in the profile at
  /// r.
  [[nodiscard]] double left_between(int count, double r) const {
    const double from = edge(r), to = reach(r, 2 * kWallTouch);
    std::vector<tooth_space::SheetPoint> lines;
    std::vector<Vec3> feeds;
    for (int i = 0; i <= count; ++i) {
      const double sigma = count > 0 ? place(double(i) / count, r) : from;
      const auto s = sheet_.raw(sigma, r), next = sheet_.raw(sigma, r + kFeedStep);
      if (!s || !next) return 0;
      lines.push_back(*s);
      feeds.push_back((next->centre - s->centre).normalized());
    }
    double most = 0;
    for (int k = 1; k <= kHeightSamples; ++k) {
      const auto s = sheet_.raw(from + (to - from) * k / kHeightSamples, r);
      if (!s) continue;
      const Vec3 p = s->contact.p + o_.allowance_mm * s->contact.n;
      double least = INFINITY;
      for (std::size_t i = 0; i < lines.size(); ++i)
        least = std::min(least, (p - lines[i].centre).cross(feeds[i]).norm() - o_.ball_radius_mm);
      most = std::max(most, least);
    }
    return most;
  }

  /// From the end of the ring to where the corner closes, at a share of the way from the crossing to the reach.
  [[nodiscard]] std::optional<BallPass> make_pass(double share, double closed) const {
    const auto begin = solve([&](double r) { return contact_at(place(share, r), r); });
    if (!begin || std::abs(closed - *begin) < kShortestPass) return {};
    const auto curve = [&](double r) -> std::optional<BallPass::Point> {
      const double at = place(share, r);
      if (std::isnan(at)) return {};
      const auto s = sheet_.raw(at, r);
      if (!s) return {};
      return BallPass::Point{s->centre, s->contact.p, true};
    };
    auto line = sample_curve(curve, *begin, closed, o_.chord_mm, 4.0 * o_.ball_radius_mm);
    if (!line || line->points.size() < 2) return {};
    BallPass pass;
    pass.points = std::move(line->points);
    const auto& first = pass.points.front();
    const Vec3 out = (first.centre - pass.points[1].centre).normalized();
    pass.points.insert(pass.points.begin(), {first.centre + o_.run_out_mm * out, first.contact, false});
    pass.outward = inner_;
    const bool plus_wall = upper_ ? !plus_ : plus_;
    if ((plus_wall == o_.climb) != pass.outward) {
      std::reverse(pass.points.begin(), pass.points.end());
      pass.outward = !pass.outward;
    }
    return pass;
  }

  const tooth_space::OffsetSheet& sheet_;
  const FinishingOptions& o_;
  const PartDistance& distance_;
  bool inner_, plus_, upper_;
  double end_ = 0;
};

}  // namespace

std::vector<BallPass> plan_corner_ends(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options,
                                       const PartDistance& distance) {
  std::vector<BallPass> out;
  if (sheet.empty() || !sheet.has_gaps()) return out;
  for (const bool inner : {true, false})
    for (const bool plus : {true, false})
      for (const bool upper : {false, true})
        for (auto& pass : OpenEnd(sheet, options, distance, inner, plus, upper).passes())
          out.push_back(std::move(pass));
  return out;
}

}  // namespace toothpath::ball
