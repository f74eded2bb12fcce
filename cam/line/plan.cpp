#include "cam/line/plan.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cam/line/misfit.h"
#include "cam/path/motion_blend.h"
#include "cam/tool/body.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::line {
namespace {

constexpr int kMostLeaning = 4;    // strips that are tried of flanks that are no upright ones
constexpr int kMoreStrips = 4;     // than the bend asks for: poses stand, and the profile bends unevenly
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

/// All passes for one choice of strips and rotaries.
struct Choice {
  int strips = 1;
  Rotaries rotaries = Rotaries::both;
};
Result<std::vector<LinePass>> passes_of(const std::vector<FlankTask>& flanks, const tool::Profile& tool,
                                        const LineOperation& o, const Choice& choice) {
  const std::size_t n = flanks.size() * std::size_t(choice.strips);
  std::vector<std::optional<Result<LinePass>>> found(n);
  WorkShare all{double(n)};
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
    const WorkShare piece(all);
    const auto& flank = flanks[k / std::size_t(choice.strips)];
    const auto strip = k % std::size_t(choice.strips);
    PassOptions p;
    p.rotaries = choice.rotaries;
    p.chord_mm = o.chord_tolerance_mm;
    p.bias_mm = o.bias_mm;
    if (int(strip) + 1 == choice.strips) p.base_lift = o.base_lift_mm;
    for (const auto& other : flanks) {
      p.lift_from = p.lift_from || other.s_to <= flank.s_from;
      p.lift_to = p.lift_to || other.s_from >= flank.s_to;
    }
    p.room = o.room;
    p.enough_mm = o.left_mm.value_or(INFINITY);
    found[k].emplace(plan_pass(LineFit(flank, *tool.law(), strips_of(flank, choice.strips)[strip]), p, tool.law_end()));
    if (*found[k]) (*found[k])->strip = int(strip);
  });
  std::vector<LinePass> out;
  for (auto& pass : found) {
    if (!*pass) return pass->error();
    out.push_back(std::move(**pass));
  }
  return out;
}

/// Adds what a choice leaves to the ways of its number of strips.
void add_way(const Choice& choice, const std::vector<LinePass>& passes, double misfit_mm,
             std::vector<LinePlan::Way>& ways) {
  const bool given_up =
      std::any_of(passes.begin(), passes.end(), [](const LinePass& pass) { return pass.records.empty(); });
  if (ways.empty() || ways.back().strips != choice.strips) ways.push_back({choice.strips, INFINITY, true});
  LinePlan::Way& way = ways.back();
  if (misfit_mm < way.misfit_mm) way.misfit_mm = misfit_mm, way.given_up = given_up;
}

double worst_of(const std::vector<LinePass>& passes) {
  double worst = 0;
  for (const auto& p : passes) worst = std::max(worst, p.misfit_mm);
  return worst;
}

/// 1, or of flanks that are straight along the tooth about as many as `left` asks for.
int least_strips(const std::vector<FlankTask>& flanks, const LineOperation& o) {
  int least = 1;
  if (o.left_mm)
    for (const auto& flank : flanks) least = std::max(least, strips_for(flank, *o.left_mm));
  return least;
}

Result<std::vector<Choice>> choices_of(const std::vector<FlankTask>& flanks, const LineOperation& o) {
  const int least = least_strips(flanks, o);
  if (!o.strips && least > kMostStrips)
    return fail(
        "left = {:.3f} um asks for {} strips of flanks that are straight along the tooth: each leaves the sag of its "
        "profile; at most {} are planned; what helps: left = {:.4f} mm, or a finishing with regions = [\"flank\"] by a "
        "ball end",
        1e3 * *o.left_mm, least, kMostStrips,
        std::ceil(1e4 * *o.left_mm * std::pow(double(least) / (kMostStrips - 1), 2)) / 1e4);
  std::vector<Rotaries> rotaries{Rotaries::both};
  if (!o.rotaries.empty()) rotaries = o.rotaries;
  else if (o.left_mm) rotaries = {Rotaries::tilt_stands, Rotaries::both};
  std::vector<Choice> out;
  const int from = o.strips.value_or(least);
  const int most = least > 1 ? std::min(least + kMoreStrips, kMostStrips) : kMostLeaning;
  const int to = o.strips || !o.left_mm ? from : std::max(most, from);
  for (int n = from; n <= to; ++n)
    for (const auto r : rotaries) out.push_back({n, r});
  return out;
}

std::string strips_text(int n) { return fmt::format("{} strip{}", n, n == 1 ? "" : "s"); }

/// No choice leaves little enough: the best one, what was tried, what would help.
std::string missed(const LineOperation& o, const std::vector<Choice>& tried, const Choice& best, double least) {
  const int from = tried.front().strips, to = tried.back().strips;
  const auto moving = [](Rotaries r) { return r == Rotaries::both ? "both rotaries move" : to_string(r); };
  std::string rotaries, help;
  bool both = false;
  for (const auto& c : tried) {
    if (c.strips != from) break;
    rotaries += fmt::format("{}{}", rotaries.empty() ? "" : " or ", moving(c.rotaries));
    both = both || c.rotaries == Rotaries::both;
  }
  if (to < kMostStrips) help += fmt::format(", more strips (at most {})", kMostStrips);
  if (!both && o.both_admitted) help += ", rotaries = \"both\"";
  return fmt::format(
      "left = {:.3f} um cannot be met: the side of this tool leaves {:.3f} um at best, with {} while {}; tried: {} "
      "while {}; what helps: left = {:.4f} mm{}, a smaller half_angle, or a finishing with regions = [\"flank\"] by a "
      "ball end",
      1e3 * o.left_mm.value_or(0), 1e3 * least, strips_text(best.strips), moving(best.rotaries),
      from == to ? strips_text(from) : fmt::format("{} to {}", from, strips_text(to)), rotaries,
      std::ceil(1e4 * least + 1) / 1e4, help);
}

/// Appends passes to a path: in and out along the tool axis, which only ever frees a tool that widens upwards.
class PathWriter {
 public:
  /// @param dip_mm  by which straight rapids may lie below the clearance height between their ends
  PathWriter(const tool::Profile& tool, const LineOperation& o, double dip_mm, path::ClPath& path)
      : o_(o), path_(path), r_0_(tool.law()->r_0), dip_mm_(dip_mm), bodies_(tool.proof_bodies(kBodySag)) {}

  void add(const FlankTask& flank, const LinePass& pass, int number) {
    std::vector<LineRecord> records = pass.records;
    if (climbs(records, flank) != o_.climb) std::reverse(records.begin(), records.end());
    zone_ = flank.zone;
    pass_ = number;
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
      record(to, records[k].axis.a, path::MoveKind::feed, feed * (to - from).norm() / contact);
    }
    record(above(records.back().axis, flank), records.back().axis.a, path::MoveKind::retract, link_feed());
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

bool shortened(const std::vector<LinePass>& passes) {
  return std::any_of(passes.begin(), passes.end(), [](const LinePass& p) { return p.shortened_mm > 0; });
}
/// Is the same number of strips tried with both rotaries after this choice?
bool both_follow(const std::vector<Choice>& choices, const Choice& choice) {
  return std::any_of(choices.begin(), choices.end(),
                     [&](const Choice& c) { return c.strips == choice.strips && c.rotaries == Rotaries::both; });
}

/// Azimuth of the axis in the middle of a pass.
double azimuth_of(const LinePass& pass) { return azimuth(pass.records[pass.records.size() / 2].axis.a); }

/// Flanks in the order in which the azimuth of the axis turns least over a tooth space and on to the next one: both
/// flanks of a space lean over opposite teeth. The first one stays; of many rings the order stays as it is.
std::vector<std::size_t> shortest_order(const std::vector<FlankTask>& flanks, const std::vector<LinePass>& passes,
                                        std::size_t strips) {
  constexpr std::size_t kMostFlanks = 8;
  std::vector<std::size_t> order(flanks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (flanks.size() > kMostFlanks || passes.size() != flanks.size() * strips) return order;
  std::vector<double> azimuths;
  for (std::size_t k = 0; k < flanks.size(); ++k) {
    if (passes[k * strips].records.empty()) return order;
    azimuths.push_back(azimuth_of(passes[k * strips]));
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

Result<LinePlan> plan_line_milling(const tooth_space::ToothedPart& part, const tool::Profile& tool,
                                   const LineOperation& o) {
  if (!tool.law())
    return fail("line milling needs a tool with a ball end and a side: flat and bull nose cutters have none");
  if (o.strips && (*o.strips < 1 || *o.strips > kMostStrips))
    return fail("strips = {} lies outside 1 .. {}", *o.strips, kMostStrips);
  auto found = flanks_of(part, o.allowance_mm);
  if (!found) return found.error();
  const std::vector<FlankTask> flanks = std::move(*found);
  LinePlan plan;
  double least = INFINITY;
  Choice best;
  std::optional<Diagnostic> refused;
  const auto asked = choices_of(flanks, o);
  if (!asked) return asked.error();
  const auto& choices = *asked;
  const WorkShare share{double(choices.size())};  // where none suits all are tried
  for (const auto& choice : choices) {
    auto passes = passes_of(flanks, tool, o, choice);
    if (!passes) {
      // What both rotaries cannot do more strips cannot either; one that stands may have failed by itself.
      if (choice.rotaries == Rotaries::both) return passes.error();
      refused = passes.error();
      continue;
    }
    plan.misfit_mm = worst_of(*passes);
    add_way(choice, *passes, plan.misfit_mm, plan.ways);
    if (plan.misfit_mm < least) best = choice;
    least = std::min(least, plan.misfit_mm);
    if (o.left_mm && plan.misfit_mm > *o.left_mm) continue;
    // A pass that ends early leaves a corner; with both rotaries there may be room.
    if (choice.rotaries != Rotaries::both && shortened(*passes) && both_follow(choices, choice)) continue;
    plan.passes = std::move(*passes);
    plan.strips = choice.strips;
    plan.rotaries = choice.rotaries;
    break;
  }
  if (plan.passes.empty() && least == INFINITY && refused) return *refused;
  if (plan.passes.empty()) return fail("{}", missed(o, choices, best, least));
  plan.ways.back().misfit_mm = plan.misfit_mm;
  if (o.strips || !o.left_mm) plan.ways.clear();
  else
    for (const FlankTask& flank : flanks) plan.ball_passes += ball_passes_for(flank, tool.law()->r_0, *o.left_mm);
  const auto strips = std::size_t(plan.strips);
  for (std::size_t k = 0; k < flanks.size(); ++k)
    measure_left(flanks[k], tool, std::span(plan.passes).subspan(k * strips, strips));
  plan.path.operation = o.operation;
  plan.path.operation_type = "line_milling";
  plan.path.tool = o.tool;
  plan.path.spindle_rpm = o.speed_rpm;
  PathWriter writer(tool, o, kDip * (o.clearance_height_mm - part.blank_top()), plan.path);
  for (const std::size_t flank : shortest_order(flanks, plan.passes, strips))
    for (std::size_t k = flank * strips; k < (flank + 1) * strips; ++k)
      writer.add(flanks[flank], plan.passes[k], int(k % (2 * strips)));
  plan.least_feed_mm_min = writer.least_feed();
  return plan;
}

}  // namespace toothpath::line
