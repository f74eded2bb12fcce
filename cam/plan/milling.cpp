#include "cam/plan/milling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "cam/analytic/gouge_check.h"
#include "cam/line/room.h"
#include "cam/path/asked_stock.h"
#include "cam/plan/beside_side.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"

namespace toothpath::plan {
namespace {

constexpr double kLiftShare = 0.5;
constexpr double kAxisStands = 1e-9;  // of a unit vector: less is no turn
constexpr int kAllAxes = 5;           // X, Y, Z and two rotaries
/// Passes of a layer are drawn together by this share at a time, and to this share of the step-over that is asked.
constexpr double kNarrower = 0.8, kNarrowest = 0.2;
constexpr std::size_t kFewMotions = 13;  // one of so many is measured before all of them are

std::vector<line::Rotaries> admitted(const path::MillingOperation& op, int simultaneous_axes) {
  using line::Rotaries;
  if (op.rotaries == path::MovingRotaries::both) return {Rotaries::both};
  if (op.rotaries == path::MovingRotaries::one || simultaneous_axes < kAllAxes)
    return {Rotaries::tilt_stands, Rotaries::azimuth_stands};
  return {Rotaries::tilt_stands, Rotaries::azimuth_stands, Rotaries::both};
}

const char* moving_text(line::Rotaries rotaries) {
  switch (rotaries) {
    case line::Rotaries::both: return "tilt and azimuth turn";
    case line::Rotaries::tilt_stands: return "the tilt stands, the azimuth turns";
    case line::Rotaries::azimuth_stands: return "the azimuth stands, the tilt turns";
  }
  return "";
}

/// One text for both flanks of a ring, or "1 strip on flank +1, 4 strips on flank -1".
template <typename TextOf>
std::string by_flank(const line::LinePlan& planned, int zone, const TextOf& text_of) {
  std::array<std::string, 2> text;
  for (const auto& pass : planned.passes)
    if (pass.zone == zone) text[pass.side > 0 ? 0 : 1] = text_of(pass);
  return text[0] == text[1] ? text[0] : fmt::format("{} on flank +1, {} on flank -1", text[0], text[1]);
}
double minutes_of(const std::vector<line::FlankWays>& ways, double line::FlankWays::*minutes) {
  return std::accumulate(ways.begin(), ways.end(), 0.0, [&](double sum, const auto& w) { return sum + w.*minutes; });
}

/// How the axis stands in the passes of one ring.
proof::DirectionChoice direction_of(const line::LinePlan& planned, int operation, int zone, double clearance_mm) {
  proof::DirectionChoice d;
  d.operation = operation;
  d.zone = zone;
  d.fixed = false;
  d.clearance_mm = clearance_mm;
  d.clearance_at_least = true;  // what was asked for
  d.least_lean_rad = INFINITY;
  Vec3 sum = Vec3::Zero();
  double misfit = 0;
  for (const auto& pass : planned.passes) {
    if (pass.zone != zone) continue;
    ++d.passes;
    ++d.turning_passes;
    misfit = std::max(misfit, pass.misfit_mm);
    for (std::size_t k = 0; k < pass.records.size(); ++k) {
      const auto& record = pass.records[k];
      sum += record.axis.a;
      const double tilt = std::acos(record.axis.a.z());
      d.least_lean_rad = std::min(d.least_lean_rad, tilt);
      d.greatest_lean_rad = std::max(d.greatest_lean_rad, tilt);
      if (k == 0) continue;
      const auto& before = pass.records[k - 1];
      const double step = std::atan2(before.axis.a.cross(record.axis.a).norm(), before.axis.a.dot(record.axis.a));
      const double way = (record.anchor - before.anchor).norm();
      d.greatest_step_rad = std::max(d.greatest_step_rad, step);
      if (way > 0) d.greatest_turn_rad_per_mm = std::max(d.greatest_turn_rad_per_mm, step / way);
    }
  }
  d.axis = sum.normalized();
  d.lean_rad = std::atan2(std::hypot(d.axis.x(), d.axis.y()), d.axis.z());
  d.explanation = fmt::format(
      "the side of the mill touches the flank along its height in {}: the axis leans {:.1f} to {:.1f} deg from "
      "the gear axis, {}; the misfit of the straight side is {:.2f} um at most, shank and holder keep {:.3f} mm or "
      "more",
      by_flank(planned, zone,
               [](const auto& pass) { return fmt::format("{} strip{}", pass.strips, pass.strips == 1 ? "" : "s"); }),
      degrees(d.least_lean_rad), degrees(d.greatest_lean_rad),
      by_flank(planned, zone, [](const auto& pass) { return moving_text(pass.rotaries); }), 1e3 * misfit, clearance_mm);
  return d;
}

constexpr double kTrialShares[] = {0, 0.05, 0.1, 0.2, 0.4, 0.8};  // of the diameter
constexpr double kTrialStep = 0.05;                               // mm

class MillingPlanner {
 public:
  MillingPlanner(const analytic::GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
                 const std::vector<path::MillingOperation>& operations, const Options& options)
      : part_(part),
        tools_(tools),
        asked_(operations),
        operations_(operations),
        o_(options),
        ball_(part, tools, operations_, options) {}

  Expected<MillingPlan, ball::PlanRefusal> run(const Progress& progress) {
    if (const auto& refusal = part_.refusal()) return ball::PlanRefusal{"gear." + refusal->key, refusal->diagnostic};
    for (std::size_t n = 0; n < operations_.size(); ++n)
      if (auto gone = stock_is_gone(n)) return std::move(*gone);
    for (std::size_t n = 0; n < operations_.size(); ++n) {
      if (progress) progress(to_string(operations_[n].type));
      auto refusal = operations_[n].type == path::OperationType::line_milling ? line(int(n)) : ball(int(n));
      if (refusal) {
        if (!o_.trial) widen_trials(int(n), *refusal);
        return std::move(*refusal);
      }
      set_feeds(n);
      if (rougher_follows(n)) remember(n);
    }
    return std::move(plan_);
  }

 private:
  /// An operation that is asked to leave more than one before it left where both cut.
  [[nodiscard]] std::optional<ball::PlanRefusal> stock_is_gone(std::size_t n) const {
    const path::MillingOperation& op = asked_[n];
    for (std::size_t k = 0; k < n; ++k) {
      const path::MillingOperation& before = asked_[k];
      const bool same = std::any_of(path::kRegions.begin(), path::kRegions.end(),
                                    [&](path::Region r) { return op.regions[r] && before.regions[r]; });
      const double pad = before.type == path::OperationType::roughing ? ball::kRoughingPad : 0;
      if (!same || before.allowance_mm + pad >= path::kAskedStock * op.allowance_mm) continue;
      return ball::PlanRefusal{
          fmt::format("operation[{}].allowance", n),
          fail("allowance = {:g} mm cannot be left: operation {} ({}) before it has cut down to {:g} mm already, below "
               "{:.4g} mm ({} of it); {:g} or less would do, or a larger allowance of operation {}",
               op.allowance_mm, k, to_string(before.type), before.allowance_mm, path::kAskedStock * op.allowance_mm,
               path::kAskedStock, before.allowance_mm, k)};
    }
    return {};
  }
  /// The tools that would do for an operation must do for all others with that tool: what the message says is right the
  /// first time.
  void widen_trials(int n, ball::PlanRefusal& refusal) const {
    const int tool = asked_[std::size_t(n)].tool;
    if (std::none_of(asked_.begin() + n + 1, asked_.end(), [&](const auto& o) { return o.tool == tool; })) return;
    const tool::ToolAssembly& now = tools_[std::size_t(tool)];
    for (const ball::ToolTrial& trial : refusal.trials) {
      const auto wide = does_for_all(tool, trial.tool);
      std::string& message = refusal.diagnostic.message;
      const std::size_t at = message.find(trial.words);
      if (at == std::string::npos) continue;
      message.replace(at, trial.words.size(),
                      wide ? ball::change_words(now, *wide) : trial.words + ", for this operation alone");
    }
  }
  /// The same change, made larger until the whole job is planned with it: the least of `kTrialShares`, by halves.
  [[nodiscard]] std::optional<tool::ToolAssembly> does_for_all(int tool, const tool::ToolAssembly& least) const {
    const tool::ToolAssembly& now = tools_[std::size_t(tool)];
    const auto as = [&](std::size_t share) { return enlarged(now, least, kTrialShares[share] * now.diameter_mm); };
    const auto does = [&](const tool::ToolAssembly& trial) {
      Options options = o_;
      options.trial = true;
      options.stage = {};
      std::vector<tool::ToolAssembly> tools = tools_;
      tools[std::size_t(tool)] = trial;
      return !MillingPlanner(part_, tools, asked_, options).run({}).refused();
    };
    if (does(as(0))) return as(0);
    std::size_t low = 0, high = std::size(kTrialShares) - 1;
    while (high > 0 && as(high).shank_diameter_mm <= 0) --high;
    if (high == 0 || !does(as(high))) return {};
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (does(as(middle)) ? high : low) = middle;
    }
    return as(high);
  }
  /// A tool whose change against another one is larger by `more` mm, to a twentieth.
  static tool::ToolAssembly enlarged(const tool::ToolAssembly& now, tool::ToolAssembly as, double more) {
    more = std::ceil(more / kTrialStep) * kTrialStep;
    if (as.shank_diameter_mm != now.shank_diameter_mm) {
      as.shank_diameter_mm -= more;
      return as;
    }
    if (as.flute_length_mm != now.flute_length_mm) as.flute_length_mm += more;
    as.stick_out_mm += more;
    as.length_mm += more;
    return as;
  }

  [[nodiscard]] std::optional<ball::PlanRefusal> ball(int n) {
    auto planned = plan_ball(n);
    if (auto* refusal = planned.refused()) return std::move(*refusal);
    if (auto refusal = too_many_axes(n, planned.value().path)) return refusal;
    plan_.paths.push_back(std::move(planned.value().path));
    plan_.operations.push_back(planned.value().summary);
    plan_.lines.emplace_back();
    for (auto& d : planned.value().directions) plan_.directions.push_back(std::move(d));
    return {};
  }

  [[nodiscard]] std::vector<const cut::Removed*> cleared() const {
    std::vector<const cut::Removed*> out;
    for (const auto& c : cleared_) out.push_back(c.get());
    return out;
  }
  /// Roughing that has a `max_engagement`: the passes of a layer are drawn together until all but those that open a
  /// layer keep it. Where no step-over does, the one that is asked stays.
  [[nodiscard]] Expected<ball::Planned, ball::PlanRefusal> plan_ball(int n) {
    path::MillingOperation& op = operations_[std::size_t(n)];
    const double asked = op.step_over_mm;
    if (op.type == path::OperationType::roughing && op.max_engagement_rad > 0 && op.max_engagement_rad < kPi) {
      const tool::Profile mill = tool::profile_of(tools_[std::size_t(op.tool)]);
      double step = std::min(asked, widest_step_mm(mill.cutting(), op.step_down_mm, op.max_engagement_rad));
      for (; step >= kNarrowest * asked; step *= kNarrower) {
        op.step_over_mm = step;
        auto planned = ball_.plan(n, cleared(), {});
        if (const auto* refused = planned.refused()) {
          if (step < asked && refused->key.ends_with(".step_over")) break;  // of narrower passes there are too many
          return planned;
        }
        if (keeps_engagement(op, planned.value(), kFewMotions) && keeps_engagement(op, planned.value(), 1))
          return planned;
      }
      engaged_.clear();
      op.step_over_mm = asked;
    }
    return ball_.plan(n, cleared(), leading_of(std::size_t(n)));
  }

  /// Leaves what was measured in `engaged_`.
  [[nodiscard]] bool keeps_engagement(const path::MillingOperation& op, const ball::Planned& planned,
                                      std::size_t one_of) {
    engaged_ = engagement_of(planned.path, one_of);
    return beside_slots(planned.path, engaged_, planned.summary).engaged_rad <= op.max_engagement_rad;
  }

  /// The ball end of a mill cuts beside the poses of its side where it leaves out the flank.
  [[nodiscard]] std::optional<ball::Leading> leading_of(std::size_t n) const {
    const path::MillingOperation& op = operations_[n];
    if (op.regions[path::Region::flank] || o_.simultaneous_axes < kAllAxes) return {};
    for (std::size_t k = n; k-- > 0;)
      if (plan_.lines[k] && operations_[k].tool == op.tool) return beside_side(part_, *plan_.lines[k], int(k));
    return {};
  }

  /// A ball whose axis turns while it cuts. One rotary turns with the tilt from the gear axis, the other with the
  /// azimuth about it.
  [[nodiscard]] std::optional<ball::PlanRefusal> too_many_axes(int n, const path::ClPath& path) const {
    for (std::size_t k = 1; k < path.records.size(); ++k) {
      const auto &from = path.records[k - 1], &to = path.records[k];
      if (to.kind != path::MoveKind::feed || (to.axis - from.axis).norm() <= kAxisStands) continue;
      const bool tilts = std::abs(std::hypot(to.axis.x(), to.axis.y()) - std::hypot(from.axis.x(), from.axis.y())) >
                         kAxisStands,
                 swings = std::abs(from.axis.x() * to.axis.y() - from.axis.y() * to.axis.x()) > kAxisStands;
      const int axes = 3 + (tilts ? 1 : 0) + (swings ? 1 : 0);
      if (axes <= o_.simultaneous_axes) continue;
      return ball::PlanRefusal{
          fmt::format("operation[{}].tool", n),
          fail("tool = {}: its axis turns while it cuts in zone {}, {} axes at once, but the control interpolates {} "
               "(max_simultaneous_axes): a thinner shank or holder or a larger stick_out, so that one direction clears "
               "the whole pass, or a tool_axis that stands",
               tools_[std::size_t(operations_[std::size_t(n)].tool)].number, to.zone, axes, o_.simultaneous_axes)};
    }
    return {};
  }

  [[nodiscard]] std::optional<ball::PlanRefusal> line(int n) {
    const path::MillingOperation& op = operations_[std::size_t(n)];
    const tool::Profile profile = tool::profile_of(tools_[std::size_t(op.tool)]);
    line::LineOperation asked;
    asked.operation = n;
    asked.tool = op.tool;
    asked.speed_rpm = op.speed_rpm;
    asked.feed_mm_min = op.feed_mm_min;
    asked.allowance_mm = op.allowance_mm;
    asked.strips = op.strips;
    asked.left_mm = op.most_misfit_mm();
    asked.rotaries = admitted(op, o_.simultaneous_axes);
    asked.both_admitted = o_.simultaneous_axes >= kAllAxes;
    asked.chord_tolerance_mm = op.chord_tolerance_mm;
    asked.bias_mm = o_.line_bias_mm;
    asked.climb = op.climb;
    asked.link_feed_mm_min = o_.link_feed_mm_min;
    asked.slow_mm = ball::slow_way(operations_, tools_, std::size_t(n));
    asked.clearance_height_mm = part_.part().blank_top() + o_.rapid_clearance_mm;
    line::RoomOptions room;
    room.clearance_mm = o_.limits.clearance_mm;
    if (op.allowance_mm > 0) {
      room.stock_mm = path::kPlannedStock * op.allowance_mm;
      // What the ball end leaves at the fillet line when it stands higher: a share of the chord.
      asked.base_lift_mm = std::sqrt(2 * profile.law()->r_0 * kLiftShare * op.chord_tolerance_mm);
    }
    asked.room = line::room_of(part_, profile, room);
    std::optional<Result<line::LinePlan>> planned;
    const auto work = [&] { planned.emplace(line::plan_line_milling(part_.part(), profile, asked)); };
    if (o_.stage) o_.stage("line passes", work);
    else work();
    if (op.best_way) return best_way(n, std::move(*planned));
    if (!*planned) return line_refusal(n, planned->error());
    keep(n, std::move(**planned));
    return {};
  }

  /// The side where it is no slower than the ball end of its mill, else that; the other one where one is refused.
  [[nodiscard]] std::optional<ball::PlanRefusal> best_way(int n, Result<line::LinePlan> side) {
    path::MillingOperation& op = operations_[std::size_t(n)];
    FlankChoice choice{n, true, {}, {}};
    auto ways = side ? Result<std::vector<line::FlankWays>>(side->ways)
                     : line::ways_by_ball(part_.part(), tools_[std::size_t(op.tool)].radius_mm(), op.most_misfit_mm(),
                                          op.feed_mm_min);
    if (!ways) return line_refusal(n, ways.error());
    choice.ways = std::move(*ways);
    if (side &&
        minutes_of(choice.ways, &line::FlankWays::minutes) <= minutes_of(choice.ways, &line::FlankWays::ball_minutes)) {
      keep(n, std::move(*side));
      return {};
    }
    if (!side) choice.refused = side.error().message;
    const path::MillingOperation asked = std::exchange(op, path::by_ball_end(op));
    auto refusal = ball(n);
    if (refusal && side) {
      op = asked;
      keep(n, std::move(*side));
      plan_.choices.back().refused = std::move(refusal->diagnostic.message);
      return {};
    }
    if (refusal)
      refusal->diagnostic.message = fmt::format("{}; by the side: {}", refusal->diagnostic.message, choice.refused);
    else plan_.choices.push_back(std::move(choice));
    return refusal;
  }

  /// What a control of fewer axes does not admit is told beside.
  [[nodiscard]] ball::PlanRefusal line_refusal(int n, Diagnostic why) const {
    if (o_.simultaneous_axes < kAllAxes)
      why.message += fmt::format(
          " (the control interpolates {} axes at once: rotaries = \"one\" is what it takes, so that more strips or a "
          "larger left must do)",
          o_.simultaneous_axes);
    return {fmt::format("operation[{}]", n), std::move(why)};
  }

  void keep(int n, line::LinePlan planned) {
    ball::OperationPlan summary;
    summary.operation = n;
    summary.passes = int(planned.passes.size());
    for (const auto& pass : planned.passes) summary.chord_mm = std::max(summary.chord_mm, pass.chord_mm);
    for (int zone = 0; zone < part_.zones(); ++zone)
      plan_.directions.push_back(direction_of(planned, n, zone, o_.limits.clearance_mm));
    plan_.choices.push_back({n, false, planned.ways, {}});
    plan_.paths.push_back(std::move(planned.path));
    plan_.operations.push_back(summary);
    plan_.lines.emplace_back(std::move(planned));
  }

  [[nodiscard]] bool rougher_follows(std::size_t n) const {
    return std::any_of(operations_.begin() + long(n) + 1, operations_.end(),
                       [](const auto& o) { return o.type == path::OperationType::roughing; });
  }
  /// By `chip_load`; what only `max_engagement` asks for is measured and leaves the feeds.
  void set_feeds(std::size_t n) {
    const path::MillingOperation& op = operations_[n];
    if (op.chip_load_mm == 0 && op.max_engagement_rad == 0) return;
    path::ClPath& path = plan_.paths[n];
    const tool::ToolAssembly& tool = tools_[std::size_t(op.tool)];
    if (op.type != path::OperationType::roughing) {
      double contact_top = 0;
      if (plan_.lines[n])
        for (const auto& pass : plan_.lines[n]->passes) contact_top = std::max(contact_top, pass.contact_top_mm);
      return feed_by_stock(path, operations_, tools_, n, contact_top);
    }
    if (engaged_.empty()) engaged_ = engagement_of(path);
    EngagementTrack track = feed_by_engagement(path, engaged_, op, tool.teeth);
    const BesideSlots beside = beside_slots(path, engaged_, plan_.operations[n]);
    track.step_over_mm = plan_.operations[n].step_over_mm;
    track.beside_rad = beside.engaged_rad;
    track.opening_mm = beside.opening_mm;
    plan_.engagement.push_back(std::move(track));
    engaged_.clear();
  }
  /// Of a roughing path, in what the operations before it have left.
  [[nodiscard]] std::vector<cut::Engaged> engagement_of(const path::ClPath& path, std::size_t one_of = 1) const {
    const tool::ToolAssembly& tool = tools_[std::size_t(path.tool)];
    const tool::Profile mill = tool::profile_of(tool);
    const tool::ProofTool bodies = tool::proof_tool(tool);
    const std::vector<const cut::Removed*> before = cleared();
    const cut::EngagementQuery query{mill,
                                     bodies.cutting,
                                     before,
                                     [&](const Vec3& p) { return part_.part().in_blank(p); },
                                     part_.part().highest_z(),
                                     one_of,
                                     part_.part().chart()};
    std::vector<cut::Engaged> engaged;
    const auto work = [&] { engaged = cut::engagement_along(analytic::GougeCheck::motions_of(path), query); };
    if (o_.stage) o_.stage("engagement", work);
    else work();
    return engaged;
  }
  void remember(std::size_t n) {
    cleared_.push_back(std::make_unique<cut::Removed>(analytic::GougeCheck::motions_of(plan_.paths[n]),
                                                      tool::proof_tool(tools_[std::size_t(operations_[n].tool)]),
                                                      part_.part().highest_z()));
  }

  const analytic::GearDistance& part_;
  const std::vector<tool::ToolAssembly>& tools_;
  const std::vector<path::MillingOperation>& asked_;
  std::vector<path::MillingOperation> operations_;  ///< as planned: step-overs may be less than asked
  const Options& o_;
  ball::Planner ball_;
  std::vector<std::unique_ptr<cut::Removed>> cleared_;
  std::vector<cut::Engaged> engaged_;  ///< of the path that was planned last, where it was asked for
  MillingPlan plan_;
};

}  // namespace

Expected<MillingPlan, ball::PlanRefusal> plan_milling(const analytic::GearDistance& part,
                                                      const std::vector<tool::ToolAssembly>& tools,
                                                      const std::vector<path::MillingOperation>& operations,
                                                      const Options& options, const Progress& progress) {
  return MillingPlanner(part, tools, operations, options).run(progress);
}

}  // namespace toothpath::plan
