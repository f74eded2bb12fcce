#include "cam/cut/engagement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::cut {
namespace {

/// Points of the cutting part at one height, in the frame of the tool.
struct PointRing {
  double height = 0, radius = 0;
  double normal_out = 1, normal_up = 0;  ///< of the surface: from the axis, along it
};

constexpr double kChipCounts =
    0.5;  // of the largest chip: the tip of a ball that sinks touches all around, and cuts little
constexpr double kPlaces = 0.2;  // of the largest radius, between the places of a motion that are looked at
// Of an overload: places, rings, and directions about the feed of which the outer ones have half the chip.
constexpr double kLoadPlaces = 0.5, kLoadRings = 0.35, kLoadHeights = 2;
constexpr int kLoadDirections = 3;  // on either side

/// @param step  between rings, of the largest radius
std::vector<PointRing> rings_of(const tool::Meridian& meridian, double step) {
  const double longest = step * meridian.largest_radius();
  std::vector<PointRing> out;
  for (const tool::MeridianPiece& piece : meridian.pieces()) {
    const double length = (piece.to - piece.from).norm() * (piece.bend != 0 ? 0.5 * kPi : 1);
    const int count = std::max(1, int(std::ceil(length / longest)));
    for (int k = 0; k < count; ++k) {
      const Vec2 chord = piece.from + (piece.to - piece.from) * ((k + 0.5) / count);
      const Vec2 at = tool::nearest_on_piece<double>(piece, chord), normal = tool::piece_normal<double>(piece, at);
      out.push_back({at[0], at[1], normal[1], normal[0]});
    }
  }
  return out;
}

/// What stands while motions are made one after the other.
class Stock {
 public:
  Stock(const std::vector<path::ToolMotion>& motions, const EngagementQuery& q)
      : q_(q), own_(cuts_of(motions), q.cutting, q.top_mm) {}

  /// Has no earlier operation cut within `least_mm` of this place?
  [[nodiscard]] bool stood(const Vec3& p, double least_mm) const {
    return q_.in_blank(p) && std::none_of(q_.before.begin(), q_.before.end(),
                                          [&](const Removed* removed) { return removed->comes_within(p, least_mm); });
  }
  /// And none of the first `done` motions that cut?
  [[nodiscard]] bool stands(const Vec3& p, std::size_t done, double least_mm) const {
    return stood(p, least_mm) && !own_.comes_within(done, p, least_mm);
  }
  /// Of every motion, how many ahead of it cut.
  static std::vector<std::size_t> done_before(const std::vector<path::ToolMotion>& motions) {
    std::vector<std::size_t> done(motions.size(), 0);
    for (std::size_t k = 1; k < motions.size(); ++k) done[k] = done[k - 1] + (motions[k - 1].rapid ? 0 : 1);
    return done;
  }

 private:
  static std::vector<path::ToolMotion> cuts_of(std::vector<path::ToolMotion> motions) {
    std::erase_if(motions, [](const path::ToolMotion& m) { return m.rapid; });
    return motions;
  }

  const EngagementQuery& q_;
  SweptTool own_;
};

class Along {
 public:
  Along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& q)
      : motions_(motions), q_(q), rings_(rings_of(q.mill.cutting(), kEngagementStep)), stock_(motions, q) {
    for (int k = 0; k < int(2 * kPi / kEngagementStep); ++k)
      around_.emplace_back(std::cos(k * kEngagementStep), std::sin(k * kEngagementStep));
  }

  std::vector<Engaged> run() const {
    const std::vector<std::size_t> done = Stock::done_before(motions_);
    std::vector<Engaged> out(motions_.size());
    WorkShare share{double(motions_.size())};
    tbb::parallel_for(std::size_t{0}, motions_.size(), [&](std::size_t k) {
      if (!motions_[k].rapid && k % q_.one_of == 0) out[k] = worst(motions_[k], done[k]);
      share.add();
    });
    return out;
  }

 private:
  [[nodiscard]] Engaged worst(const path::ToolMotion& m, std::size_t done) const {
    Engaged most;
    const double way = (m.tip_to - m.tip_from).norm();
    if (way == 0) return most;
    const int places = std::max(1, int(std::ceil(way / (kPlaces * q_.mill.cutting().largest_radius()))));
    for (int k = 0; k <= places; ++k) at(m, double(k) / places, done, most);
    return most;
  }

  void at(const path::ToolMotion& m, double t, std::size_t done, Engaged& most) const {
    const Vec3 tip = path::tip_at(m, t), axis = path::axis_at(m, t), feed = (m.tip_to - m.tip_from).normalized();
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    double steepest = 0;
    std::vector<Engaged> at_heights;
    std::vector<Vec3> around;
    for (const Vec2& turn : around_) around.emplace_back(turn.x() * u + turn.y() * v);
    for (const PointRing& ring : rings_) {
      Engaged here;
      for (const Vec3& out : around) {
        const double along = (ring.normal_out * out + ring.normal_up * axis).dot(feed);
        if (along <= 0 || !stock_.stands(tip + ring.height * axis + ring.radius * out, done, kThinnestStock)) continue;
        here.angle_rad += kEngagementStep;
        here.steepest = std::max(here.steepest, along);
      }
      steepest = std::max(steepest, here.steepest);
      at_heights.push_back(here);
    }
    most.steepest = std::max(most.steepest, steepest);
    for (const Engaged& here : at_heights) {
      if (here.steepest >= kChipCounts * steepest) most.angle_rad = std::max(most.angle_rad, here.angle_rad);
      if (here.steepest >= kChipCounts) most.loaded_rad = std::max(most.loaded_rad, here.angle_rad);
    }
  }

  const std::vector<path::ToolMotion>& motions_;
  const EngagementQuery& q_;
  std::vector<PointRing> rings_;
  std::vector<Vec2> around_;  ///< cosine and sine
  Stock stock_;
};

class OverloadAlong {
 public:
  OverloadAlong(const std::vector<path::ToolMotion>& motions, const EngagementQuery& q, const AskedLoad& asked)
      : motions_(motions),
        asked_(asked),
        in_blank_(q.in_blank),
        cutting_(q.cutting),
        chart_(q.chart),
        rings_(rings_of(q.mill.cutting(), kLoadRings)),
        radius_(q.mill.cutting().largest_radius()),
        one_of_(q.one_of),
        asks_more_(asked.step_down_mm > 0 || asked.stock_mm < INFINITY),
        stock_(motions, q) {
    std::sort(rings_.begin(), rings_.end(), [](const auto& a, const auto& b) { return a.height < b.height; });
  }

  Overload run() const {
    const std::vector<std::size_t> done = Stock::done_before(motions_);
    const std::vector<bool> apart = far_apart();
    std::vector<Overload> found(motions_.size());
    WorkShare share{double(motions_.size())};
    tbb::parallel_for(std::size_t{0}, motions_.size(), [&](std::size_t k) {
      if (!motions_[k].rapid && k % one_of_ == 0) found[k] = along(motions_[k], done[k], apart[k]);
      share.add();
    });
    Overload most;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Overload& f = found[k];
      const int line = motions_[k].line;
      if (f.chip_share > most.chip_share) most.chip_share = f.chip_share, most.chip_line = line;
      if (f.depth_mm > most.depth_mm) most.depth_mm = f.depth_mm, most.depth_line = line;
      if (f.stock_mm > most.stock_mm) most.stock_mm = f.stock_mm, most.stock_line = line;
    }
    return most;
  }

 private:
  /// A point of the cutting part where it goes into the work.
  struct Edge {
    Vec3 at;
    double share = 0;   ///< of the feed along its normal
    double height = 0;  ///< above the tip
    double layer = 0;   ///< h of the chart above the lowest place of the mill: the same where its axis stands upright
  };

  /// Motions so far along the way that they are asked for more than their chips; all of them where the query leaves
  /// some out.
  [[nodiscard]] std::vector<bool> far_apart() const {
    std::vector<bool> apart(motions_.size(), asks_more_);
    double way = INFINITY;  // since the last one; from a rapid on the first one counts
    for (std::size_t k = 0; k < motions_.size() && asks_more_ && one_of_ == 1; ++k) {
      const path::ToolMotion& m = motions_[k];
      way = m.rapid ? INFINITY : way + (m.tip_to - m.tip_from).norm();
      apart[k] = way >= kLoadPlaces * radius_;
      if (apart[k] && !m.rapid) way = 0;
    }
    return apart;
  }
  [[nodiscard]] Overload along(const path::ToolMotion& m, std::size_t done, bool asks_more) const {
    Overload most;
    const double way = (m.tip_to - m.tip_from).norm();
    if (way == 0) return most;
    const double quick = asked_.feed_mm_min == INFINITY ? 0
                         : m.minutes > 0                ? way / m.minutes / asked_.feed_mm_min
                                                        : INFINITY;
    if (quick <= kLoadFactor && !asks_more) return most;  // no chip is larger than the feed
    const int places = std::max(1, int(std::ceil(way / (kLoadPlaces * radius_))));
    for (int k = 0; k < places; ++k)
      for (const Edge& e : edges(m, (k + 0.5) / places)) look(e, quick, done, most);
    return most;
  }
  [[nodiscard]] std::vector<Edge> edges(const path::ToolMotion& m, double t) const {
    const Vec3 tip = path::tip_at(m, t), axis = path::axis_at(m, t), feed = (m.tip_to - m.tip_from).normalized();
    const Vec3 across = feed - feed.dot(axis) * axis;
    const Vec3 u = across.norm() > kAlongAxis ? Vec3(across.normalized()) : Vec3(axis.unitOrthogonal());
    const Vec3 v = axis.cross(u);
    const double low = lowest(tip, axis);
    std::array<Vec3, 2 * kLoadDirections + 1> about_feed;
    for (int k = -kLoadDirections; k <= kLoadDirections; ++k) {
      const double a = k * kHalfChip / kLoadDirections;
      about_feed[std::size_t(k + kLoadDirections)] = std::cos(a) * u + std::sin(a) * v;
    }
    std::vector<Edge> out;
    for (const PointRing& ring : rings_)
      for (const Vec3& n : about_feed) {
        const double share = (ring.normal_out * n + ring.normal_up * axis).dot(feed);
        if (share < kLeastShare) continue;
        const Vec3 at = tip + ring.height * axis + ring.radius * n;
        out.push_back({at, share, ring.height, chart_.up(at) - low});
      }
    return out;
  }
  /// h of the lowest place of the cutting part.
  [[nodiscard]] double lowest(const Vec3& tip, const Vec3& axis) const {
    const Vec3 up = chart_.up_at(azimuth(tip)), at(0, 0, tip.dot(up)), leans(0, 0, axis.dot(up));
    double low = INFINITY;
    for (const tool::RoundedFrustum& body : cutting_) low = std::min(low, tool::lowest_z(body, at, leans));
    return low;
  }
  void look(const Edge& e, double quick, std::size_t done, Overload& most) const {
    const double chip = quick * e.share;
    if (chip > std::max(kLoadFactor, most.chip_share) && lies_below(e.at, kLeastStock, done)) most.chip_share = chip;
    const double deep = kLoadFactor * asked_.step_down_mm;  // what is deeper stands there, too
    if (deep > 0 && e.share >= kAhead && e.layer > std::max(deep, most.depth_mm) &&
        e.layer < deep + kLoadHeights * radius_ && lies_below(e.at, kLeastStock, done))
      most.depth_mm = e.layer;
    if (!(asked_.stock_mm < INFINITY)) return;
    for (double stock = std::max({kLoadFactor * asked_.stock_mm, kDeeper * most.stock_mm, kLeastStock});
         stock < radius_ && within_blank(e.at, stock) && stock_.stood(e.at, stock); stock *= kDeeper)
      most.stock_mm = stock;
  }
  /// So far below all that is free, the outside of the blank too.
  [[nodiscard]] bool lies_below(const Vec3& p, double depth_mm, std::size_t done) const {
    return within_blank(p, depth_mm) && stock_.stands(p, done, depth_mm);
  }
  [[nodiscard]] bool within_blank(const Vec3& p, double depth_mm) const {
    const double at = azimuth(p);
    const Vec3 up = chart_.up_at(at), along = chart_.along_at(at);
    return in_blank_(p + depth_mm * up) && in_blank_(p + depth_mm * along) && in_blank_(p - depth_mm * along);
  }

  static constexpr double kHalfChip = kPi / 3;  // about the feed on either side: the chip is half as thick there
  static constexpr double kAlongAxis = 1e-6;    // of a feed: less has no direction across the axis
  static constexpr double kDeeper = 1.1;
  static constexpr double kLeastShare =
      0.1;                                // of the feed along the normal: what slides along a wall takes nothing off
  static constexpr double kAhead = 0.85;  // of the feed along the normal: beside it ridges of the layer above may stand
  const std::vector<path::ToolMotion>& motions_;
  const AskedLoad& asked_;
  const std::function<bool(const Vec3&)>& in_blank_;
  const std::vector<tool::RoundedFrustum>& cutting_;
  tooth_space::Chart chart_;
  std::vector<PointRing> rings_;
  double radius_;
  std::size_t one_of_;
  bool asks_more_;  ///< than about chips
  Stock stock_;
};

}  // namespace

Overload overload_along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& query,
                        const AskedLoad& asked) {
  return OverloadAlong(motions, query, asked).run();
}

std::vector<Engaged> engagement_along(const std::vector<path::ToolMotion>& motions, const EngagementQuery& query) {
  return Along(motions, query).run();
}

}  // namespace toothpath::cut
