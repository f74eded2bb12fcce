#include "cam/line/plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include "cam/line/misfit.h"
#include "cam/path/motion_blend.h"
#include "cam/tool/body.h"
#include "geometry/base/angle.h"

namespace toothpath::line {
namespace {

constexpr double kDip = 0.5;       // share of the clearance of rapids
constexpr double kBodySag = 0.01;  // mm: how far bodies may stand out of the tool where only rapids ask for them

Result<std::vector<FlankTask>> flanks_of(const tooth_space::ToothedPart& part, double allowance_mm) {
  std::vector<FlankTask> flanks;
  for (int zone = 0; zone < part.zones(); ++zone)
    for (const int side : {1, -1}) {
      auto task = flank_task(part, zone, side, allowance_mm);
      if (!task) return task.error();
      flanks.push_back(*task);
    }
  return flanks;
}

/// Appends passes to a path: in and out along the tool axis, which only ever frees a tool that widens upwards.
class PathWriter {
 public:
  /// @param dip_mm  by which straight rapids may lie below the clearance height between their ends
  PathWriter(const tool::Profile& tool, const LineOperation& o, double dip_mm, path::ClPath& path)
      : o_(o), path_(path), r_0_(tool.law()->r_0), dip_mm_(dip_mm), bodies_(tool.proof_bodies(kBodySag)) {}

  /// Answers its minutes at the feed of the contact.
  double add(const FlankTask& flank, const LinePass& pass) {
    std::vector<LineRecord> records = pass.records;
    if (climbs(records, flank) != o_.climb) std::reverse(records.begin(), records.end());
    zone_ = flank.zone;
    pass_ = pass.number;
    double minutes = 0;
    const AxisLine<double>& first = records.front().axis;
    if (!path_.records.empty() && flank.chart().sine != 0) around(above(first, flank), first.a, flank);
    record(above(first, flank), first.a, path::MoveKind::rapid, 0);
    if ((above(first, flank) - tip(first)).norm() > o_.slow_mm)
      record(tip(first) + o_.slow_mm * first.a, first.a, path::MoveKind::engage, link_feed());
    record(tip(first), first.a, path::MoveKind::engage, o_.feed_mm_min);
    for (std::size_t k = 1; k < records.size(); ++k) {
      const double contact = (records[k].anchor - records[k - 1].anchor).norm();
      const Vec3 from = tip(records[k - 1].axis), to = tip(records[k].axis);
      const double feed =
          contact_feed(o_.feed_mm_min, o_.limits, contact, from, records[k - 1].axis.a, to, records[k].axis.a);
      least_feed_ = std::min(least_feed_, feed);
      minutes += contact / feed;
      record(to, records[k].axis.a, path::MoveKind::feed, feed * (to - from).norm() / contact);
    }
    record(above(records.back().axis, flank), records.back().axis.a, path::MoveKind::retract, link_feed());
    return minutes;
  }
  [[nodiscard]] double link_feed() const { return std::max(o_.feed_mm_min, o_.link_feed_mm_min); }
  [[nodiscard]] double least_feed() const { return least_feed_; }

 private:
  [[nodiscard]] Vec3 tip(const AxisLine<double>& axis) const { return axis.c_0 - r_0_ * axis.a; }
  /// Along the axis until ball, flutes, shank and holder are above the clearance height. `up` at one place is enough:
  /// no h of the chart is less than what it measures.
  [[nodiscard]] Vec3 above(const AxisLine<double>& axis, const FlankTask& flank) const {
    const Vec3 up = flank.up(axis.c_0), at(0, 0, tip(axis).dot(up)), leans(0, 0, axis.a.dot(up));
    double lowest = axis.c_0.dot(up) - bodies_.ball_radius_mm;
    for (const auto& f : bodies_.frustums) lowest = std::min(lowest, tool::lowest_z(f, at, leans));
    return tip(axis) + std::max(0.0, (o_.clearance_height_mm - lowest) / leans.z()) * axis.a;
  }
  /// Rapids towards a place above the clearance height, where that is round.
  void around(const Vec3& to, const Vec3& axis, const FlankTask& flank) {
    const path::ClRecord from = path_.records.back();
    const int pieces = path::pieces_about_axis(from.tip, to, dip_mm_);
    for (int k = 1; k < pieces; ++k) {
      const double t = double(k) / pieces;
      const Vec3 a = ((1 - t) * from.axis + t * axis).normalized();
      record(above({from.tip + t * (to - from.tip) + r_0_ * a, a}, flank), a, path::MoveKind::rapid, 0);
    }
  }
  /// Is the material to the right of the feed, seen from the holder?
  [[nodiscard]] bool climbs(const std::vector<LineRecord>& records, const FlankTask& flank) const {
    const std::size_t k = records.size() / 2;
    const Vec3 feed = records[k].anchor - records[k - 1].anchor, right = feed.cross(records[k].axis.a);
    const auto on = flank.space->point(flank.piece(), records[k].at.u, records[k].at.v);
    return on && on->n.dot(right) < 0;
  }
  void record(const Vec3& tip, const Vec3& axis, path::MoveKind kind, double feed) {
    path_.records.push_back({tip, axis, feed, kind, zone_, pass_});
  }

  const LineOperation& o_;
  path::ClPath& path_;
  double r_0_, dip_mm_, least_feed_ = INFINITY;
  tool::ProofBodies bodies_;
  int zone_ = 0, pass_ = 0;
};

/// Azimuth of the axis in the middle of a pass.
double azimuth_of(const LinePass& pass) { return azimuth(pass.records[pass.records.size() / 2].axis.a); }

/// Flanks in the order in which the azimuth of the axis turns least over a tooth space and on to the next one: both
/// flanks of a space lean over opposite teeth. The first one stays; of many rings the order stays as it is.
/// @param flanks  the passes of each
std::vector<std::size_t> shortest_order(const std::vector<std::span<LinePass>>& flanks) {
  constexpr std::size_t kMostFlanks = 8;
  std::vector<std::size_t> order(flanks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (flanks.size() > kMostFlanks) return order;
  std::vector<double> azimuths;
  for (const auto& passes : flanks) {
    if (passes.front().records.empty()) return order;
    azimuths.push_back(azimuth_of(passes.front()));
  }
  const auto turn_of = [&](const std::vector<std::size_t>& trial) {
    double turn = 0;
    for (std::size_t k = 0; k < trial.size(); ++k)
      turn += std::abs(std::remainder(azimuths[trial[(k + 1) % trial.size()]] - azimuths[trial[k]], 2 * kPi));
    return turn;
  };
  std::vector<std::size_t> best = order;
  while (std::next_permutation(order.begin() + 1, order.end()))
    if (turn_of(order) < turn_of(best) - 1e-6) best = order;
  return best;
}

}  // namespace

double contact_feed(double feed_mm_min, const FeedLimits& limits, double contact_mm, const Vec3& tip_from,
                    const Vec3& axis_from, const Vec3& tip_to, const Vec3& axis_to) {
  double feed = feed_mm_min;
  const auto limit = [&](double way, double most) {
    if (way > 0) feed = std::min(feed, most * contact_mm / way);
  };
  limit((tip_to - tip_from).norm(), limits.tip_mm_min);
  limit(std::abs(std::acos(std::clamp(axis_to.z(), -1.0, 1.0)) - std::acos(std::clamp(axis_from.z(), -1.0, 1.0))),
        limits.tilt_rad_min);
  limit(std::abs(std::atan2(axis_from.x() * axis_to.y() - axis_from.y() * axis_to.x(),
                            axis_from.x() * axis_to.x() + axis_from.y() * axis_to.y())),
        limits.azimuth_rad_min);
  limit(limits.block_s / 60, 1.0);
  return feed;
}

Result<std::vector<FlankWays>> ways_by_ball(const tooth_space::ToothedPart& part, double ball_radius_mm, double left_mm,
                                            double feed_mm_min) {
  const auto flanks = flanks_of(part, 0);
  if (!flanks) return flanks.error();
  std::vector<FlankWays> out;
  for (const FlankTask& flank : *flanks) {
    const int passes = ball_passes_for(flank, ball_radius_mm, left_mm);
    out.push_back({flank.zone, flank.side, {}, 0, passes, passes * length_along(flank) / feed_mm_min});
  }
  return out;
}

Result<LinePlan> plan_line_milling(const tooth_space::ToothedPart& part, const tool::Profile& tool,
                                   const LineOperation& o) {
  if (!tool.law())
    return fail("line milling needs a tool with a ball end and a side: flat and bull nose cutters have none");
  if (o.strips && (*o.strips < 1 || *o.strips > kMostStrips))
    return fail("strips = {} lies outside 1 .. {}", *o.strips, kMostStrips);
  const auto flanks = flanks_of(part, o.allowance_mm);
  if (!flanks) return flanks.error();
  auto planned = plan_flanks(*flanks, tool, o);
  if (!planned) return planned.error();
  LinePlan plan;
  if (o.left_mm) {
    auto ways = ways_by_ball(part, tool.law()->r_0, *o.left_mm, o.feed_mm_min);
    if (!ways) return ways.error();
    plan.ways = std::move(*ways);
  }
  plan.rotaries = planned->front().passes.front().rotaries;
  std::map<int, int> numbers;  // of the passes of a zone so far
  for (std::size_t k = 0; k < planned->size(); ++k) {
    plan.misfit_mm = std::max(plan.misfit_mm, (*planned)[k].misfit_mm());
    if (o.left_mm) plan.ways[k].strips = std::move((*planned)[k].ways);
    for (LinePass& pass : (*planned)[k].passes) {
      plan.strips = std::max(plan.strips, pass.strips);
      if (pass.rotaries != plan.rotaries) plan.rotaries = Rotaries::both;
      pass.number = numbers[pass.zone]++;
      plan.passes.push_back(std::move(pass));
    }
  }
  std::vector<std::span<LinePass>> of_flanks;
  for (std::size_t first = 0; first < plan.passes.size(); first += std::size_t(plan.passes[first].strips)) {
    of_flanks.push_back(std::span(plan.passes).subspan(first, std::size_t(plan.passes[first].strips)));
    measure_left((*flanks)[of_flanks.size() - 1], tool, of_flanks.back());
  }
  plan.path.operation = o.operation;
  plan.path.operation_type = "line_milling";
  plan.path.tool = o.tool;
  plan.path.spindle_rpm = o.speed_rpm;
  PathWriter writer(tool, o, kDip * (o.clearance_height_mm - part.blank_top()), plan.path);
  for (const std::size_t k : shortest_order(of_flanks))
    for (const LinePass& pass : of_flanks[k]) {
      const double minutes = writer.add((*flanks)[k], pass);
      if (o.left_mm) plan.ways[k].minutes += minutes;
    }
  plan.least_feed_mm_min = writer.least_feed();
  return plan;
}

}  // namespace toothpath::line
