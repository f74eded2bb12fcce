#include "cam/ball/corner_ends.h"

#include <tbb/parallel_for.h>

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
constexpr double kSpotStep = 0.01;      // in sigma: places behind a corner that are looked at, at an end of the ring
constexpr int kSpotRows = 12;           // of them, from the end inwards to a ball radius, closer at the end
constexpr double kSamePlace = 1e-9;     // along the tooth, mm

/// One end of the ring: what is behind the corners there.
class RingEnd {
 public:
  RingEnd(const tooth_space::OffsetSheet& sheet, const FinishingOptions& o, const PartDistance& distance, bool inner)
      : sheet_(sheet), o_(o), distance_(distance), inner_(inner) {
    const auto& zone = sheet.space().outline();
    end_ = inner ? zone.s_from : zone.s_to;
  }

 protected:
  [[nodiscard]] double inward() const { return inner_ ? 1 : -1; }
  [[nodiscard]] double contact_at(double sigma, double r) const {
    if (std::isnan(sigma)) return NAN;
    const auto s = sheet_.raw(sigma, r);
    return s ? sheet_.space().outline().chart.along(s->contact.p) : NAN;
  }
  [[nodiscard]] bool clear(double sigma, double r, double touch) const {
    const auto s = sheet_.raw(sigma, r);
    return s && distance_(s->centre) >= sheet_.delta() - touch;
  }
  /// Points from the end inwards: with the run-out, and fed as the passes of its wall are.
  [[nodiscard]] BallPass as_pass(std::vector<BallPass::Point> points, const Vec3& outwards, bool plus_wall) const {
    BallPass pass;
    pass.points = std::move(points);
    const auto first = pass.points.front();
    pass.points.insert(pass.points.begin(), {first.centre + o_.run_out_mm * outwards, first.contact, false});
    pass.outward = inner_;
    if ((plus_wall == o_.climb) != pass.outward) {
      std::reverse(pass.points.begin(), pass.points.end());
      pass.outward = !pass.outward;
    }
    return pass;
  }

  const tooth_space::OffsetSheet& sheet_;
  const FinishingOptions& o_;
  const PartDistance& distance_;
  bool inner_;
  double end_ = 0;
};

/// One wall of one corner at one end of the ring.
class OpenEnd : RingEnd {
 public:
  /// `plus`: the corner lies on the plus side of the root land. `upper`: the wall after the gap (in sigma), else the
  /// one before it.
  OpenEnd(const tooth_space::OffsetSheet& sheet, const FinishingOptions& o, const PartDistance& distance, bool inner,
          bool plus, bool upper)
      : RingEnd(sheet, o, distance, inner), plus_(plus), upper_(upper) {}

  std::vector<BallPass> passes() const {
    // s of the centre: where the corner closes, and where the farthest pass leaves the ring.
    const auto closed = solve([&](double r) { return contact_at(other_edge(r), r); });
    const auto opened = solve([&](double r) { return contact_at(place(1, r), r); });
    if (!closed || !opened) return {};
    if (inward() * (*closed - *opened) < kShortestPass) return {};
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
    const Vec3 out = (line->points[0].centre - line->points[1].centre).normalized();
    return as_pass(std::move(line->points), out, upper_ ? !plus_ : plus_);
  }

  bool plus_, upper_;
};

/// Spots behind the corners at one end of the ring that the ball reaches there, because a wall has ended, and that no
/// pass covers: they need not lie beside a crossing, as on the root land between two walls.
class EndSpots : RingEnd {
 public:
  using RingEnd::RingEnd;

  /// Adds to `laid` what is missing; nothing where they leave no more than is asked.
  void cover(std::vector<BallPass>& laid) const {
    std::vector<Spot> spots = reached_behind_corners();
    const auto note = [&](Spot& spot, const BallPass& pass) {
      for (std::size_t k = 1; k < pass.points.size(); ++k)
        spot.left = std::min(spot.left, above(spot.p, pass.points[k - 1].centre, pass.points[k].centre));
    };
    tbb::parallel_for(std::size_t(0), spots.size(), [&](std::size_t n) {
      for (const BallPass& pass : laid) note(spots[n], pass);
    });
    for (int count = 0; count < kMostPasses; ++count) {
      const auto worst = std::max_element(
          spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.left - a.asked < b.left - b.asked; });
      if (worst == spots.end() || worst->left <= worst->asked) return;
      auto pass = pass_over(*worst);
      worst->asked = INFINITY;  // once
      if (!pass) continue;
      for (Spot& spot : spots) note(spot, *pass);
      laid.push_back(std::move(*pass));
    }
  }

 private:
  struct Spot {
    double sigma = 0, r = 0;  ///< of the centre
    Vec3 p = Vec3::Zero();    ///< on what is left
    double asked = 0, left = INFINITY;
  };

  /// Height of a place above what a ball leaves on its way.
  [[nodiscard]] double above(const Vec3& p, const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from;
    const double t = way.isZero() ? 0 : std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return (p - from - t * way).norm() - o_.ball_radius_mm;
  }
  /// s of the centre whose contact lies at `along`.
  [[nodiscard]] std::optional<double> centre_of(double sigma, double along) const {
    double r = along;
    for (int k = 0; k < 30; ++k) {
      const double error = along - contact_at(sigma, std::clamp(r, sheet_.r_from(), sheet_.r_to()));
      if (std::isnan(error)) return {};
      if (std::abs(error) < kSamePlace) return r;
      r += error;
      if (r < sheet_.r_from() || r > sheet_.r_to()) return {};
    }
    return {};
  }
  /// From the end inwards, as long as there are any.
  [[nodiscard]] std::vector<Spot> reached_behind_corners() const {
    std::vector<Spot> all;
    for (int row = 0; row <= kSpotRows; ++row) {
      const double inside = o_.ball_radius_mm * row * row / (kSpotRows * kSpotRows);
      const double along = end_ + inward() * inside;
      std::vector<double> sigmas;
      for (const auto& gap : sheet_.gaps(std::clamp(along, sheet_.r_from(), sheet_.r_to())))
        for (double sigma = gap.from + kSpotStep; sigma < gap.to; sigma += kSpotStep)
          if (o_.regions[FinishingOptions::region_at(sigma)]) sigmas.push_back(sigma);
      std::vector<std::optional<Spot>> found(sigmas.size());
      tbb::parallel_for(std::size_t(0), sigmas.size(), [&](std::size_t n) { found[n] = spot(sigmas[n], along); });
      const std::size_t before = all.size();
      for (const auto& one : found)
        if (one) all.push_back(*one);
      if (all.size() == before) break;
    }
    return all;
  }
  [[nodiscard]] std::optional<Spot> spot(double sigma, double along) const {
    const auto r = centre_of(sigma, along);
    if (!r || !clear(sigma, *r, kWallTouch)) return {};
    const auto s = sheet_.raw(sigma, *r);
    return Spot{sigma, *r, s->contact.p + o_.allowance_mm * s->contact.n, o_.scallop(sigma), INFINITY};
  }

  /// From the end of the ring past the spot, to where its ball comes to a wall.
  [[nodiscard]] std::optional<BallPass> pass_over(const Spot& spot) const {
    const auto end = centre_of(spot.sigma, end_);
    const double from = end && clear(spot.sigma, *end, kWallTouch) ? *end : spot.r;
    const auto first = sheet_.raw(spot.sigma, from), next = sheet_.raw(spot.sigma, from + inward() * kFeedStep);
    if (!first || !next) return {};
    double good = spot.r, bad = spot.r + inward() * o_.ball_radius_mm;
    bad = std::clamp(bad, sheet_.r_from(), sheet_.r_to());
    for (int k = 0; k < 24; ++k) {
      const double m = 0.5 * (good + bad);
      (clear(spot.sigma, m, kWallTouch) ? good : bad) = m;
    }
    const auto curve = [&](double r) -> std::optional<BallPass::Point> {
      const auto s = sheet_.raw(spot.sigma, r);
      return s ? std::optional(BallPass::Point{s->centre, s->contact.p, true}) : std::nullopt;
    };
    std::vector<BallPass::Point> points{{first->centre, first->contact.p, true}};
    if (std::abs(good - from) >= kShortestPass) {
      auto line = sample_curve(curve, from, good, o_.chord_mm, 4.0 * o_.ball_radius_mm);
      if (!line) return {};
      points = std::move(line->points);
    }
    return as_pass(std::move(points), (first->centre - next->centre).normalized(), spot.sigma < 2.5);
  }
};

}  // namespace

std::vector<BallPass> plan_corner_ends(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options,
                                       const PartDistance& distance, std::vector<BallPass> laid) {
  if (sheet.empty() || !sheet.has_gaps()) return {};
  const std::size_t before = laid.size();
  for (const bool inner : {true, false})
    for (const bool plus : {true, false})
      for (const bool upper : {false, true}) {
        if (!options.regions[path::Region::fillet]) continue;
        for (auto& pass : OpenEnd(sheet, options, distance, inner, plus, upper).passes())
          laid.push_back(std::move(pass));
      }
  for (const bool inner : {true, false}) EndSpots(sheet, options, distance, inner).cover(laid);
  laid.erase(laid.begin(), laid.begin() + long(before));
  return laid;
}

}  // namespace toothpath::ball
