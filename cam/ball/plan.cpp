#include "cam/ball/plan.h"

#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/ball/corner_ends.h"
#include "cam/ball/linking.h"
#include "cam/ball/prescribed_axes.h"
#include "cam/ball/roughing.h"
#include "cam/ball/sheet_pass.h"
#include "cam/ball/small_cusps.h"
#include "cam/ball/tool_direction.h"
#include "cam/ball/tool_orientation.h"
#include "cam/path/asked_stock.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::ball {
namespace {

/// Least cosine between the tool axis and the normals of the surface, beyond that of the cutter's own side.
constexpr double kLeastDraft = 0.01;

/// Of the chord tolerance, this share is spent on placing points; the rest covers the rounding of words and the proof.
constexpr double kChordShare = 0.6;

/// Of that tolerance, the share for ball centres that leave the pass because the axis turns.
constexpr double kTurnShare = 0.1;

/// Of the stock that an operation leaves, the share that its chords may take at most; the turning axis and the rounding
/// of words come on top.
constexpr double kStockShare = 0.15;

/// Hops in which the axis turns keep this much more than the clearance, mm: they are looked at in steps.
constexpr double kTurnMargin = 0.02;

/// What is tried where a tool has no passes: shares of its diameter; of the module, how much farther out a zone begins
/// that begins close to its limit; and to which a diameter is told, mm.
constexpr double kSmallerBalls[] = {0.85, 0.7, 0.5, 0.3}, kFartherOut[] = {0.02, 0.05, 0.1, 0.2, 0.4};
constexpr double kToldSize = 0.01;

// Of the run-out that is wanted: less is none. mm to which an allowance that would do is told.
constexpr double kLeastRunOut = 0.05, kToldAllowance = 0.001;

// mm that a roughing ball keeps from the ring across a relief groove, or its allowance where that is more.
constexpr double kAir = 0.1;

// mm beyond the stock that a hop looks for it.
constexpr double kStockMargin = 0.05;

double lower_bound_between(double d0, double d1, double length) {
  const double g = std::min(d0 * d0, d1 * d1) - length * length / 4;
  return g > 0 ? std::sqrt(g) : 0;
}

}  // namespace

class Planner::Work {
 public:
  Work(const analytic::GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
       const std::vector<path::MillingOperation>& operations, const PlanOptions& options)
      : part_(part), tools_(tools), operations_(operations), o_(options) {}

  Expected<Planned, PlanRefusal> run(int n, const std::vector<const cut::Removed*>& cleared, const Leading* leading) {
    cleared_ = cleared;
    leading_ = leading;
    plan_ = {};
    const auto& op = operation(n);
    plan_.path.operation = plan_.summary.operation = n;
    plan_.path.operation_type = to_string(op.type);
    plan_.path.tool = op.tool;
    plan_.path.spindle_rpm = op.speed_rpm;
    // Rings know nothing of each other's passes; directions and links follow in order, each on all threads.
    std::vector<std::optional<Expected<ZonePasses, PlanRefusal>>> zones(std::size_t(part_.zones()));
    as_stage("tool passes", [&] {
      WorkShare all{double(zones.size())};
      tbb::parallel_for(std::size_t(0), zones.size(), [&](std::size_t zone) {
        const WorkShare piece(all);
        zones[zone] = plan_passes(n, int(zone));
      });
    });
    for (std::size_t zone = 0; zone < zones.size(); ++zone) {
      if (const auto* refusal = (*zones[zone]).refused()) {
        PlanRefusal told = *refusal;
        const bool of_steps = told.key.find(".step_") != std::string::npos ||
                              told.key.find(".scallop") != std::string::npos;  // another tool helps them little
        if (!o_.trial && !of_steps) told.diagnostic.message += what_would_do(n, int(zone));
        return told;
      }
      if (auto refusal = lead_tool(n, int(zone), (*zones[zone]).value(), plan_.path, plan_.summary)) return *refusal;
    }
    if (plan_.path.records.empty()) return nothing_to_cut(n);
    return std::move(plan_);
  }

 private:
  /// What an operation does in one zone, before the tool has a direction.
  struct ZonePasses {
    tooth_space::OffsetSheet sheet;
    std::vector<BallPass> passes;
    OperationPlan summary;  ///< of this zone alone
  };
  [[nodiscard]] static std::string key_of(int n) { return "operation[" + std::to_string(n) + "]"; }
  [[nodiscard]] const path::MillingOperation& operation(int n) const { return operations_[std::size_t(n)]; }
  [[nodiscard]] const tool::ToolAssembly& tool_of(int n) const { return tools_[std::size_t(operation(n).tool)]; }

  [[nodiscard]] Expected<ZonePasses, PlanRefusal> plan_passes(int n, int zone) const {
    const auto& op = operation(n);
    const auto& tool = tool_of(n);
    const double R = tool.radius_mm(), delta = R + op.allowance_mm;
    const auto& ring = part_.space(zone).outline();
    const bool roughing = op.type == path::OperationType::roughing;
    // How far the ball may go beyond the ends: free into the air, limited where the other ring of teeth stands.
    const double wanted = run_out(roughing, R, delta), room = room_beyond(zone, roughing, R, delta, wanted);
    if (room < kLeastRunOut * wanted) return no_run_out(n, zone, room, kLeastRunOut * wanted);
    const double margin = std::max(delta, room) + 0.1;
    ZonePasses out{tooth_space::OffsetSheet(part_.space(zone), roughing ? delta + kRoughingPad : delta,
                                            ring.s_from - margin, ring.s_to + margin, roughing ? 65 : 33),
                   {},
                   {}};
    if (auto refusal = check_width(out.sheet, key_of(n), zone, tool)) return *refusal;
    if (auto refusal = roughing ? rough(n, room, out) : finish(n, zone, room, out)) return *refusal;
    if (auto refusal = check_ways(out.passes, tool, key_of(n), zone)) return *refusal;
    out.summary.passes = int(out.passes.size());
    return out;
  }

  /// An operation for which no pass is left.
  [[nodiscard]] PlanRefusal nothing_to_cut(int n) const {
    const auto& op = operation(n);
    const tool::ToolAssembly& tool = tool_of(n);
    if (op.type == path::OperationType::roughing)
      return {key_of(n),
              fail("roughing with tool {} has nothing to cut: none of its {} passes meets more than {:.4f} mm ({:g} of "
                   "its diameter) of what the operations before it leave; leave this operation out, or take a smaller "
                   "tool or a smaller allowance (now {:g})",
                   tool.number, plan_.summary.skipped_passes, path::kSkinShare * tool.diameter_mm, path::kSkinShare,
                   op.allowance_mm)};
    std::vector<const char*> regions;
    for (const path::Region region : path::kRegions)
      if (op.regions[region]) regions.push_back(to_string(region));
    return {
        key_of(n),
        fail("tool {} finds no pass on {}: with a ball of {:.4f} mm and an allowance of {:g} mm no place of the tooth "
             "space is cut there alone; leave this operation out, or name more regions",
             tool.number, fmt::join(regions, ", "), 2 * tool.radius_mm(), op.allowance_mm)};
  }

  /// In words: the largest ball and the least inner radius with which the same passes were planned; as trials.
  [[nodiscard]] std::string what_would_do(int n, int zone) const {
    std::vector<std::string> found;
    const double diameter = tool_of(n).diameter_mm;
    for (const double share : kSmallerBalls) {
      std::vector<tool::ToolAssembly> tools = tools_;
      tool::ToolAssembly& tool = tools[std::size_t(operation(n).tool)];
      tool.diameter_mm = std::floor(share * diameter / kToldSize) * kToldSize;
      tool.corner_radius_mm = std::min(tool.corner_radius_mm, 0.5 * tool.diameter_mm);
      if (tool.diameter_mm < kToldSize || operation(n).scallop_mm > 0.2 * tool.diameter_mm) break;
      if (Work(part_, tools, operations_, o_).plan_passes(n, zone).refused()) continue;
      found.push_back(fmt::format("a diameter of {:.2f} mm (now {:g})", tool.diameter_mm, diameter));
      break;
    }
    if (auto words = later_begin_that_does(n, zone)) found.push_back(std::move(*words));
    if (found.empty()) return "; a smaller tool that would do was not found";
    return fmt::format("; would do, planned as a trial: {}", fmt::join(found, ", or "));
  }
  /// Of a zone that begins close to where its flanks begin, in words.
  [[nodiscard]] std::optional<std::string> later_begin_that_does(int n, int zone) const {
    for (const double share : kFartherOut) {
      auto moved = part_.part().begun_later(zone, share);
      if (!moved) break;
      if (!moved->part) continue;
      const analytic::GearDistance part(moved->part, reach_of(tools_));
      if (part.refusal() || Work(part, tools_, operations_, o_).plan_passes(n, zone).refused()) continue;
      return std::move(moved->words);
    }
    return {};
  }

  /// How far a ball should go beyond the ends of a zone. mm
  [[nodiscard]] static double run_out(bool roughing, double R, double delta) {
    return roughing ? 0.6 * delta + 0.1 : 0.5 * R;
  }
  [[nodiscard]] PlanRefusal no_run_out(int n, int zone, double room, double least) const {
    const path::MillingOperation& op = operation(n);
    const bool roughing = op.type == path::OperationType::roughing;
    const double R = tool_of(n).radius_mm();
    const auto fits = [&](double allowance) {
      const double delta = R + allowance, wanted = run_out(roughing, R, delta);
      return room_beyond(zone, roughing, R, delta, wanted) >= kLeastRunOut * wanted;
    };
    if (op.allowance_mm == 0 || !fits(0))
      return {key_of(n) + ".tool", fail("a ball of {:.4f} mm has no room to run out into the relief groove of zone {}: "
                                        "the way left is {:.4f} mm, at least {:.4f} mm is needed",
                                        2 * R, zone, room, least)};
    double low = 0, high = op.allowance_mm;
    while (high - low > kToldAllowance) (fits(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return {key_of(n) + ".allowance",
            fail("allowance = {:g} mm cannot stay on the ring across the relief groove of zone {}: a ball of {:.4f} mm "
                 "has {:.4f} mm left to run out into it, at least {:.4f} mm is needed; {:.3f} or less would do, or a "
                 "wider groove",
                 op.allowance_mm, zone, 2 * R, room, least, std::floor(low / kToldAllowance) * kToldAllowance)};
  }

  /// Way that a ball has beyond the ends of a zone, at most `wanted`. mm
  [[nodiscard]] double room_beyond(int zone, bool roughing, double R, double delta, double wanted) const {
    const auto& ring = part_.space(zone).outline();
    double room = wanted;
    for (int k = 0; k < part_.zones(); ++k) {
      const auto& other = part_.space(k).outline();
      const double gap = std::max(other.s_from - ring.s_to, ring.s_from - other.s_to);
      if (gap <= 0) continue;
      // The centre of a ball in contact at the end lies at most 0.7 delta beyond it.
      room = std::min(room, roughing ? gap - std::max(R + kAir, delta) : gap - 1.7 * delta - 0.05);
    }
    return room;
  }

  [[nodiscard]] std::optional<PlanRefusal> rough(int n, double room, ZonePasses& out) const {
    const auto& op = operation(n);
    RoughingOptions r;
    r.ball_radius_mm = tool_of(n).radius_mm();
    r.allowance_mm = op.allowance_mm;
    r.step_down_mm = op.step_down_mm;
    r.step_over_mm = op.step_over_mm;
    r.chord_mm = std::min(kChordShare * op.chord_tolerance_mm, chord_room(op));
    r.overrun_mm = room;
    r.blank_top_mm = part_.part().blank_top();
    r.climb = op.climb;
    r.end_centre_mm = tool::end_centre_mm(tool_of(n));
    if (auto small = steps_too_small(out.sheet, r))
      return PlanRefusal{key_of(n) + "." + small->key, std::move(small->diagnostic)};
    auto planned = plan_roughing(out.sheet, r, cleared_);
    if (!planned) return PlanRefusal{key_of(n) + ".tool", planned.error()};
    out.passes = std::move(planned->passes);
    out.summary.layers = planned->layers;
    out.summary.step_over_mm = op.step_over_mm;
    out.summary.skipped_passes = planned->skipped;
    out.summary.chord_mm = r.chord_mm;
    return {};
  }

  [[nodiscard]] std::optional<PlanRefusal> finish(int n, int zone, double room, ZonePasses& out) const {
    const auto& op = operation(n);
    const auto& tool = tool_of(n);
    FinishingOptions f;
    f.ball_radius_mm = tool.radius_mm();
    f.allowance_mm = op.allowance_mm;
    for (const path::Region region : path::kRegions) f.scallop_mm[region] = op.scallop_in(region);
    f.regions = op.regions;
    f.chord_mm = kChordShare * op.chord_tolerance_mm;
    f.chord_mm = std::min(f.chord_mm, chord_room(op));
    f.run_out_mm = room;
    f.climb = op.climb;
    if (auto small = cusps_too_small(out.sheet, f))
      return PlanRefusal{key_of(n) + "." + small->key, std::move(small->diagnostic)};
    auto planned = plan_finishing(out.sheet, f);
    if (!planned) return PlanRefusal{key_of(n) + ".tool", planned.error()};
    out.passes = std::move(planned->passes);
    const auto distance = [&](const Vec3& centre) {
      return part_.nearest(centre, f.ball_radius_mm + op.allowance_mm + 0.01).distance;
    };
    for (auto& pass : plan_corner_ends(out.sheet, f, distance, out.passes)) out.passes.push_back(std::move(pass));
    out.summary.scallop_max_mm = planned->scallop_max_mm;
    out.summary.crest_lean = planned->crest_lean;
    out.summary.chord_mm = planned->worst_chord_mm;
    out.summary.corner_passes = planned->corner_passes;
    if (auto refusal = check_passes(out.passes, tool, key_of(n), zone)) return refusal;
    trim_run_outs(out.passes, f.ball_radius_mm, op.allowance_mm);
    return {};
  }

  static void add(OperationPlan& all, const OperationPlan& zone, bool finishing) {
    all.layers = std::max(all.layers, zone.layers);
    all.step_over_mm = std::max(all.step_over_mm, zone.step_over_mm);
    all.skipped_passes += zone.skipped_passes;
    all.chord_mm = std::max(all.chord_mm, zone.chord_mm);
    all.corner_passes = all.corner_passes || zone.corner_passes;
    all.passes += zone.passes;
    if (!finishing) return;
    all.scallop_max_mm = std::max(all.scallop_max_mm, zone.scallop_max_mm);
    all.crest_lean = std::max(all.crest_lean, zone.crest_lean);
  }

  static void note_openings(int zone, const std::vector<BallPass>& passes, OperationPlan& summary) {
    int number = 0;  // as `link_passes` counts
    for (const BallPass& pass : passes) {
      if (pass.points.empty()) continue;
      if (pass.opens_layer) summary.openings.emplace_back(zone, number);
      ++number;
    }
  }

  /// Tool directions for the passes of a zone, and the links between them: its records.
  [[nodiscard]] std::optional<PlanRefusal> lead_tool(int n, int zone, ZonePasses& made, path::ClPath& path,
                                                     OperationPlan& summary) {
    add(summary, made.summary, operation(n).type != path::OperationType::roughing);
    if (made.passes.empty()) return {};
    LinkingOptions link;
    proof::DirectionChoice direction;
    if (auto refusal = direct(n, zone, made, direction, link.axes)) return refusal;
    plan_.directions.push_back(direction);
    note_openings(zone, made.passes, summary);
    const auto& op = operation(n);
    const double R = tool_of(n).radius_mm();
    const auto& ring = part_.space(zone).outline();
    const tooth_space::Chart& chart = ring.chart;
    link.centre_mm = tool::end_centre_mm(tool_of(n));
    link.axis = direction.axis;
    link.clearance = proof::Roof(chart, part_.part().blank_top() + o_.rapid_clearance_mm);
    link.most_dip_mm = 0.5 * o_.rapid_clearance_mm;
    link.hop_mm = 0.2 * R + op.allowance_mm;
    link.longest_hop_mm = 1.5 * part_.part().pitch() * chart.r(ring.s_to, part_.space(zone).tip(ring.s_to));
    link.feed_mm_min = op.feed_mm_min;
    link.link_feed_mm_min = std::max(op.feed_mm_min, o_.link_feed_mm_min);
    link.slow_mm = slow_way(operations_, tools_, std::size_t(n));
    link.zone = zone;
    link.bodies = tool::shank_and_holder(tool_of(n));
    // A turn past the pole is left to the clearance height, but for axes that the job prescribes.
    const double off_pole = op.axis_plus.empty() ? o_.least_tilt_rad : 0;
    const auto bodies_are_clear = [&](const Vec3& centre, const Vec3& axis) {
      if (std::atan2(std::hypot(axis.x(), axis.y()), axis.z()) < off_pole) return false;
      return bodies_->clear(link.bodies, centre - link.centre_mm * axis, axis, o_.limits.clearance_mm + kTurnMargin,
                            0.01);
    };
    as_stage("links", [&] {
      const double stock = stock_before(operations_, tools_, std::size_t(n));
      link_passes(
          made.passes, link,
          [&](const HopEnd& a, const HopEnd& b) {
            if (hop_is_outside(a, b, tool_of(n))) return Meets::air;
            return hop_meets(a.centre, b.centre, R, op.allowance_mm, op.allowance_mm + stock);
          },
          path.records, bodies_are_clear);
    });
    return {};
  }

  /// What must stay on the flanks, which flutes pass by: where an operation leaves them out, no more than there was.
  [[nodiscard]] double left_on_flanks(int n) const {
    const double own = operation(n).allowance_mm;
    if (operation(n).regions[path::Region::flank]) return own;
    const auto before = path::last_before(operations_, std::size_t(n), path::Region::flank);
    return before ? std::min(own, operations_[*before].allowance_mm) : own;
  }

  /// One direction for the whole zone, or axes for every point: as prescribed, or where no fixed direction is clear.
  [[nodiscard]] std::optional<PlanRefusal> direct(int n, int zone, ZonePasses& made, proof::DirectionChoice& direction,
                                                  std::vector<std::vector<Vec3>>& axes) {
    const auto& op = operation(n);
    const auto& tool = tool_of(n);
    OrientationOptions turning;
    turning.clearance_mm = o_.limits.clearance_mm;
    turning.allowance_mm = left_on_flanks(n);
    turning.least_tilt_rad = o_.least_tilt_rad;
    turning.trial = o_.trial;
    turning.chord_mm = kTurnShare * std::min(op.chord_tolerance_mm, chord_room(op));
    const bool prescribed = !op.axis_plus.empty();
    direction.operation = n;
    direction.zone = zone;
    if (leading_ && !prescribed && is_led(zone, tool, op, turning, made.passes, direction, axes)) return {};
    turning.least_draft += std::sin(tool.half_angle_rad);
    as_stage("tool direction", [&] {
      if (!bodies_) bodies_ = std::make_unique<analytic::BodyTree>(part_);
      if (!prescribed)
        direction = choose_direction(part_, *bodies_, zone, made.sheet, made.passes, tool,
                                     {o_.limits.clearance_mm, o_.clearance_room_mm,
                                      kLeastDraft + std::sin(tool.half_angle_rad), turning.allowance_mm});
    });
    direction.operation = n;
    direction.zone = zone;
    if (prescribed) {
      auto oriented = prescribe(zone, tool, op, turning, made.passes);
      if (const auto* refusal = oriented.refused())
        return PlanRefusal{key_of(n) + ".tool_axis",
                           fail("tool {} in zone {}: {}", tool.number, zone, refusal->reason)};
      describe_prescribed(oriented.value(), direction);
      axes = std::move(oriented.value().axes);
    } else if (!direction.fixed) {
      auto oriented = orient(zone, tool, turning, made.passes);
      if (const auto* refusal = oriented.refused()) {
        plan_.directions.push_back(direction);
        return PlanRefusal{
            key_of(n) + ".tool",
            fail("tool {} in zone {}: {}; {}", tool.number, zone, direction.explanation, refusal->reason),
            refusal->trials};
      }
      describe(oriented.value(), direction);
      axes = std::move(oriented.value().axes);
    }
    return {};
  }

  /// The first of the leading axes with which the tool keeps clear, if there is one.
  [[nodiscard]] bool is_led(int zone, const tool::ToolAssembly& tool, path::MillingOperation op,
                            OrientationOptions options, std::vector<BallPass>& passes,
                            proof::DirectionChoice& direction, std::vector<std::vector<Vec3>>& axes) {
    options.least_draft = std::sin(tool.half_angle_rad);
    if (!bodies_) bodies_ = std::make_unique<analytic::BodyTree>(part_);
    for (const LedAxes& led : leading_->zones[std::size_t(zone)]) {
      op.axis_plus = led.plus;
      op.axis_minus = led.minus;
      std::vector<BallPass> trial = passes;
      // One flank after the other: between them the axis turns far.
      std::stable_partition(trial.begin(), trial.end(), [&](const BallPass& p) { return p.outward == op.climb; });
      auto oriented = prescribe(zone, tool, op, options, trial);
      if (oriented.refused()) continue;
      passes = std::move(trial);
      measure(oriented.value(), direction);
      direction.explanation = fmt::format(
          "{}: lean {:.1f} to {:.1f} deg from the normal of the pitch surface; shank and holder keep {:.3f} mm",
          leading_->words, degrees(oriented.value().least_lean_rad), degrees(oriented.value().greatest_lean_rad),
          oriented.value().clearance_mm);
      axes = std::move(oriented.value().axes);
      return true;
    }
    return false;
  }

  /// Simultaneous axes for one zone.
  [[nodiscard]] Expected<Orientation, OrientationRefusal> orient(int zone, const tool::ToolAssembly& tool,
                                                                 const OrientationOptions& options,
                                                                 std::vector<BallPass>& passes) const {
    std::optional<Expected<Orientation, OrientationRefusal>> result;
    as_stage("five-axis orientation", [&] {
      const std::vector<BallPass> as_planned = passes;
      result.emplace(orient_passes(part_, *bodies_, zone, tool, options, passes));
      if (!result->refused() || !o_.pole_is_passed) return;
      OrientationOptions anywhere = options;
      anywhere.least_tilt_rad = 0;
      passes = as_planned;
      auto again = orient_passes(part_, *bodies_, zone, tool, anywhere, passes);
      if (!again.refused()) result.emplace(std::move(again));
    });
    return std::move(*result);
  }
  /// The same with the axes that the operation prescribes.
  [[nodiscard]] Expected<Orientation, OrientationRefusal> prescribe(int zone, const tool::ToolAssembly& tool,
                                                                    const path::MillingOperation& op,
                                                                    const OrientationOptions& options,
                                                                    std::vector<BallPass>& passes) const {
    std::optional<Expected<Orientation, OrientationRefusal>> result;
    as_stage("five-axis orientation",
             [&] { result.emplace(prescribe_axes(part_, *bodies_, zone, tool, op, options, passes)); });
    return std::move(*result);
  }
  void as_stage(const char* name, const std::function<void()>& work) const {
    if (o_.stage) o_.stage(name, work);
    else work();
  }

  static void measure(const Orientation& o, proof::DirectionChoice& d) {
    Vec3 sum = Vec3::Zero();
    for (const auto& pass : o.axes)
      for (const auto& axis : pass) sum += axis;
    d.axis = sum.normalized();
    d.lean_rad = std::atan2(std::hypot(d.axis.x(), d.axis.y()), d.axis.z());
    d.clearance_mm = o.clearance_mm;
    d.clearance_at_least = o.clearance_at_least;
    d.least_lean_rad = o.least_lean_rad;
    d.greatest_lean_rad = o.greatest_lean_rad;
    d.greatest_turn_rad_per_mm = o.greatest_turn_rad_per_mm;
    d.greatest_step_rad = o.greatest_step_rad;
    d.passes = int(o.axes.size());
    d.turning_passes = o.turning_passes;
  }
  static std::string room(const Orientation& o) {
    return fmt::format("{}{:.3f} mm", o.clearance_at_least ? "at least " : "", o.clearance_mm);
  }
  static void describe(const Orientation& o, proof::DirectionChoice& d) {
    measure(o, d);
    d.explanation = fmt::format(
        "{}; so the axis turns: lean {:.1f} to {:.1f} deg from the normal of the pitch surface, inside {} of {} "
        "passes, by at most {:.2f} deg/mm; shank and holder keep {}",
        d.explanation, degrees(o.least_lean_rad), degrees(o.greatest_lean_rad), o.turning_passes, o.axes.size(),
        degrees(o.greatest_turn_rad_per_mm), room(o));
  }
  static void describe_prescribed(const Orientation& o, proof::DirectionChoice& d) {
    measure(o, d);
    d.fixed = std::all_of(o.axes.begin(), o.axes.end(), [&](const auto& pass) {
      return std::all_of(pass.begin(), pass.end(), [&](const Vec3& axis) { return axis == o.axes.front().front(); });
    });
    d.explanation =
        d.fixed
            ? fmt::format("prescribed: leans {:.2f} deg from the normal of the pitch surface; shank and holder keep {}",
                          degrees(o.greatest_lean_rad), room(o))
            : fmt::format(
                  "prescribed: lean {:.2f} to {:.2f} deg from the normal of the pitch surface, the axis turns inside "
                  "{} of {} passes, by at most {:.2f} deg/mm; shank and holder keep {}",
                  degrees(o.least_lean_rad), degrees(o.greatest_lean_rad), o.turning_passes, o.axes.size(),
                  degrees(o.greatest_turn_rad_per_mm), room(o));
  }

  /// Sag that an operation may have: a tenth of the stock that it leaves, and less than half of what may be gouged. Of
  /// the stock 0.8 must stay: where that is smaller, a share of it.
  [[nodiscard]] double chord_room(const path::MillingOperation& op) const {
    const double room = 0.1 * op.allowance_mm + 0.4 * o_.limits.gouge_mm;
    return op.allowance_mm > 0 ? std::min(room, kStockShare * op.allowance_mm) : room;
  }

  /// A planned place, or a way between two, at which the ball would cut deeper than may be gouged is refused before any
  /// motion is made of it.
  [[nodiscard]] std::optional<PlanRefusal> check_passes(const std::vector<BallPass>& passes,
                                                        const tool::ToolAssembly& tool, const std::string& key,
                                                        int zone) const {
    const auto deep = first_deep_place(passes, tool.radius_mm(), o_.limits.gouge_mm, distance_within(tool));
    if (!deep) return {};
    return cuts_in(tool, key, zone, deep->cut_mm, deep->centre, "");
  }
  [[nodiscard]] std::optional<PlanRefusal> check_ways(const std::vector<BallPass>& passes,
                                                      const tool::ToolAssembly& tool, const std::string& key,
                                                      int zone) const {
    const auto deep = first_deep_way(passes, tool.radius_mm(), o_.limits.gouge_mm, distance_within(tool));
    if (!deep) return {};
    return cuts_in(tool, key, zone, deep->cut_mm, deep->centre, " on the way between two places of a pass");
  }
  [[nodiscard]] DistanceToPart distance_within(const tool::ToolAssembly& tool) const {
    return [this, look = tool.radius_mm() + 0.01](const Vec3& centre) { return part_.nearest(centre, look).distance; };
  }
  [[nodiscard]] PlanRefusal cuts_in(const tool::ToolAssembly& tool, const std::string& key, int zone, double cut,
                                    const Vec3& centre, const char* where) const {
    return {key + ".tool",
            fail("tool {} in zone {}: its ball of radius {:.4f} mm would cut {:.4f} mm into the finished surface with "
                 "its centre at radius {:.4f}, height {:.4f}{}; the limit is {:.4f} mm{}",
                 tool.number, zone, tool.radius_mm(), cut, radius(centre), centre.z(), where, o_.limits.gouge_mm,
                 part_.part().close_to_limit(zone))};
  }

  /// Run-outs go straight on beyond the ends of the ring; where the end of a tooth stands in the way (close to an
  /// undercut) the pass ends with its last contact instead.
  void trim_run_outs(std::vector<BallPass>& passes, double R, double allowance) const {
    tbb::parallel_for(std::size_t(0), passes.size(), [&](std::size_t n) {
      auto& q = passes[n].points;
      const auto contact = [](const BallPass::Point& p) { return p.touching; };
      const auto last = std::find_if(q.rbegin(), q.rend(), contact);
      if (last == q.rend()) return;
      for (auto k = std::size_t(q.rend() - last); k < q.size(); ++k)
        if (!segment_is_clear(q[k - 1].centre, q[k].centre, R, allowance)) {
          q.resize(k);
          break;
        }
      for (auto k = std::size_t(std::find_if(q.begin(), q.end(), contact) - q.begin()); k > 0; --k)
        if (!segment_is_clear(q[k].centre, q[k - 1].centre, R, allowance)) {
          q.erase(q.begin(), q.begin() + long(k));
          break;
        }
    });
  }

  [[nodiscard]] bool segment_is_clear(const Vec3& a, const Vec3& b, double R, double allowance) const {
    const int steps = std::max(4, int(std::ceil((b - a).norm() / (0.05 * R))));
    for (int k = 0; k <= steps; ++k) {
      const double d = part_.nearest(a + (b - a) * (double(k) / steps), R + allowance + 0.05).distance;
      if (d < R + (allowance > 0 ? path::kPlannedStock * allowance : -0.4 * o_.limits.gouge_mm)) return false;
    }
    return true;
  }

  /// A ball that does not fit between the flanks is refused with the width that it finds.
  static std::optional<PlanRefusal> check_width(const tooth_space::OffsetSheet& sheet, const std::string& key, int zone,
                                                const tool::ToolAssembly& tool) {
    const auto& ring = sheet.space().outline();
    if (sheet.empty() || sheet.r_to() - sheet.r_from() < 0.5 * (ring.s_to - ring.s_from))
      return PlanRefusal{key + ".tool", fail("the ball-centre surface of tool {} (ball of {:.4f} mm) does not reach "
                                             "over zone {}: the flank ends (undercut) or is hollower than the ball",
                                             tool.number, tool.diameter_mm, zone)};
    for (const auto& s : sheet.stations()) {
      const auto &a = s.nodes.front(), &b = s.nodes.back();
      const double width = (b.azimuth - a.azimuth) * ring.chart.r(s.r, ring.chart.up(a.at.centre));
      if (width <= 0)
        return PlanRefusal{
            key + ".tool",
            fail("tool {} (ball of {:.4f} mm) is wider than the tooth space of zone {}: at {} {:.3f} its centre "
                 "has {:.4f} mm of room between the flanks at the tip, it needs more than 0",
                 tool.number, tool.diameter_mm, zone, ring.along, ring.sign * s.r, width)};
    }
    return {};
  }

  /// Both ends of a hop touch the finished surface (or keep the allowance); in between there must be air.
  [[nodiscard]] Meets hop_meets(const Vec3& a, const Vec3& b, double R, double allowance, double stock) const {
    const double length = (b - a).norm(), least = R + path::kPlannedStock * allowance - std::max(1e-3 - allowance, 0.0),
                 look = std::max(R + 0.2, std::min(R + stock + kStockMargin, reach_of(tools_)));
    const int steps = std::max(1, int(std::ceil(length / (0.25 * R))));
    double previous = part_.nearest(a, look).distance, nearest = previous;
    for (int k = 1; k <= steps; ++k) {
      const double d = part_.nearest(a + (b - a) * (double(k) / steps), look).distance;
      if (d < least || previous < least) return Meets::part;
      const double between = lower_bound_between(previous, d, length / steps);
      if (k > 1 && k < steps && between < 0.9 * R) return Meets::part;
      nearest = std::min(nearest, between);
      previous = d;
    }
    return nearest > R + stock ? Meets::air : Meets::stock;
  }
  /// Does the cutting part stay beside all rings of teeth?
  [[nodiscard]] bool hop_is_outside(const HopEnd& a, const HopEnd& b, const tool::ToolAssembly& tool) const {
    const double widest = std::max(tool.radius_mm(), tool::profile_of(tool).cutting().largest_radius());
    const tooth_space::Chart& chart = part_.part().chart();
    double low = INFINITY, high = -INFINITY;
    for (const double above : {0.0, tool.flute_length_mm - tool::end_centre_mm(tool)}) {
      const Vec3 from = a.centre + above * a.axis, to = b.centre + above * b.axis;
      const Vec2 start = from.head<2>(), way = to.head<2>() - start;
      const double t = way.isZero() ? 0 : std::clamp(-start.dot(way) / way.squaredNorm(), 0.0, 1.0);
      const tooth_space::Range r{(start + t * way).norm(), std::max(start.norm(), to.head<2>().norm())},
          z{std::min(from.z(), to.z()), std::max(from.z(), to.z())}, s = chart.along(r, z);
      low = std::min(low, s.low - widest);
      high = std::max(high, s.high + widest);
    }
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const auto& ring = part_.space(zone).outline();
      if (!(high < ring.s_from || low > ring.s_to)) return false;
    }
    return true;
  }

  const analytic::GearDistance& part_;
  const std::vector<tool::ToolAssembly>& tools_;
  const std::vector<path::MillingOperation>& operations_;
  const PlanOptions& o_;
  std::vector<const cut::Removed*> cleared_;
  const Leading* leading_ = nullptr;
  std::unique_ptr<analytic::BodyTree> bodies_;  ///< built with the first zone
  Planned plan_;
};

Planner::Planner(const analytic::GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
                 const std::vector<path::MillingOperation>& operations, const PlanOptions& options)
    : work_(std::make_unique<Work>(part, tools, operations, options)) {}
Planner::~Planner() = default;

Expected<Planned, PlanRefusal> Planner::plan(int operation, const std::vector<const cut::Removed*>& cleared,
                                             const std::optional<Leading>& leading) {
  return work_->run(operation, cleared, leading ? &*leading : nullptr);
}

double stock_before(const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
                    std::size_t n) {
  const path::MillingOperation& op = operations[n];
  if (op.type == path::OperationType::roughing) return INFINITY;
  double stock = 0;
  for (const path::Region region : path::kRegions) {
    if (!op.regions[region]) continue;
    const auto k = path::last_before(operations, n, region);
    if (!k) return INFINITY;
    const path::MillingOperation& before = operations[*k];
    const tool::ToolAssembly &tool = tools[std::size_t(op.tool)], &its = tools[std::size_t(before.tool)];
    if (its.radius_mm() > tool.radius_mm() || !tool::serves(its, tool::CutterUse::ball_end)) return INFINITY;
    double left = path::left_by(before, its.radius_mm()) - op.allowance_mm;
    if (before.type == path::OperationType::roughing) left += path::kSkinShare * its.diameter_mm;
    stock = std::max(stock, left);
  }
  return stock;
}

double slow_way(const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
                std::size_t n) {
  constexpr double kAir = 0.2, kSteepest = 0.17;  // mm; sine of a draft
  const path::MillingOperation& op = operations[n];
  const tool::ToolAssembly& tool = tools[std::size_t(op.tool)];
  const double steep = tool.half_angle_rad > 0 ? std::min(kSteepest, std::sin(tool.half_angle_rad)) : kSteepest;
  if (op.type != path::OperationType::roughing) return kAir + stock_before(operations, tools, n) / steep;
  // The layer above, or what was thought not worth a pass of it.
  return kAir + op.step_down_mm + (n > 0 ? path::kSkinShare * tool.diameter_mm / steep : 0);
}

double reach_of(const std::vector<tool::ToolAssembly>& tools) {
  double most = 0.5;
  for (const auto& t : tools) {
    most = std::max(most, t.radius_mm());
    if (tool::serves(t, tool::CutterUse::side)) most = std::max(most, tool::profile_of(t).cutting().largest_radius());
  }
  return 1.3 * most + 0.6;
}

}  // namespace toothpath::ball
