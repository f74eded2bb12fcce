#include "app/process/milled/milling.h"

#include <algorithm>
#include <memory>
#include <tuple>

#include "app/process/least_values.h"
#include "app/process/milled/ledger.h"
#include "app/process/proof_limits.h"
#include "cam/ball/plan.h"
#include "cam/cut/swept_tool.h"
#include "cam/plan/first_ball.h"
#include "postproc/joints/pole.h"

namespace toothpath::milled {
namespace {

constexpr double kLinkFeed = 6000;   // mm/min: of moves under feed through air, where the machine is no slower
constexpr double kSmallFirst = 0.7;  // of what the space admits: a first roughing tool that is told
constexpr double kBiasShare = 0.4;   // of the rounding, taken up by the poses: the rest is counted

cut::CutSurfaceOptions surface_options(const process::FlankGrid& grid) {
  cut::CutSurfaceOptions options;
  if (grid.rows > 0) options.flank_rows = grid.rows;
  if (grid.columns > 0) options.columns = grid.columns;
  return options;
}

/// What a gap of shank and holder may lose from plan to proof.
double clearance_room(const proof::ProofLimits& limits, const machines::Machine& machine, double outer_radius_mm,
                      const std::vector<tool::ToolAssembly>& tools) {
  double longest = 0;
  for (const tool::ToolAssembly& tool : tools) longest = std::max(longest, tool.stick_out_mm);
  const process::Taken taken = process::taken_by(machine, outer_radius_mm + longest);
  return limits.proof_mm + taken.of_gouge(limits.gouge_mm) + taken.turns_mm;
}

plan::Options plan_options(const proof::ProofLimits& limits, const machines::Machine& machine, double outer_radius_mm,
                           const std::vector<tool::ToolAssembly>& tools) {
  plan::Options options;
  options.limits = limits;
  options.clearance_room_mm = clearance_room(limits, machine, outer_radius_mm, tools);
  options.limits.gouge_mm = process::planned_gouge(limits.gouge_mm, process::taken_by(machine, outer_radius_mm));
  options.link_feed_mm_min = std::min(machine.max_cutting_feed, kLinkFeed);
  options.simultaneous_axes = machine.max_simultaneous_axes;
  options.line_bias_mm = line::kBias + kBiasShare * process::word_rounding(machine, outer_radius_mm);
  // `tilt` keeps what it asks between two records, too, where the axis dips by less than this margin.
  if (machine.post.pole == machines::PoleOption::tilt)
    options.least_tilt_rad =
        std::max(options.least_tilt_rad, machine.post.pole_angle_rad.value_or(joints::kLeastPoleTilt) + 1e-3);
  options.pole_is_passed =
      machine.post.pole != machines::PoleOption::error && machine.post.pole != machines::PoleOption::tilt;
  return options;
}

void add_side_passes(const line::LinePlan& plan, int operation, std::vector<report::PassReport>& out) {
  for (const auto& pass : plan.passes) {
    report::SidePass side{pass.side, pass.strip, to_string(pass.rotaries), pass.left_mm, pass.contact_top_mm, {}};
    for (const auto& s : pass.stations) side.stations.push_back({s.at, s.lean, s.tilt, s.misfit});
    std::string name = fmt::format("flank {:+d}", pass.side);
    if (pass.strips > 1) name += fmt::format(", strip {}", pass.strip);
    out.push_back({operation, pass.zone, pass.number, std::move(name), true, pass.contact_mm, pass.records.size(),
                   std::move(side)});
  }
}

/// Passes that end before their flank does, and why.
std::vector<std::string> shortened_passes(const plan::MillingPlan& plan) {
  std::vector<std::string> out;
  for (std::size_t n = 0; n < plan.lines.size(); ++n) {
    if (!plan.lines[n]) continue;
    for (const line::LinePass& pass : plan.lines[n]->passes) {
      const auto& b = pass.shortened_by;
      if (!b) continue;
      std::string text = fmt::format(
          "operation {}: the pass on zone {}, flank {:+d} ends early: beyond its end the {} has a gap of {:.4f} mm to "
          "the {}, {:.4f} mm is the least; a wider groove, or a mill of smaller diameter or half_angle",
          n, pass.zone, pass.side, b->body, b->gap_mm, b->patch, b->least_mm);
      out.push_back(std::move(text));
    }
  }
  return out;
}

}  // namespace

Milling::Milling(const job::Job& job, const machines::Machine& machine, analytic::GearDistance part, GearBody body,
                 const proof::ProofLimits& limits, const process::FlankGrid& grid,
                 const std::optional<report::ModifiedFlanks>& modified)
    : job_(job),
      modified_(modified ? modified->zones : std::vector<report::ModifiedFlanks::Zone>{}),
      limits_(limits),
      options_(plan_options(limits, machine, body.links.radius_mm, job.tools)),
      planned_operations_(
          process::with_room_for_words(job.operations, process::taken_by(machine, body.links.radius_mm))),
      part_(std::move(part)),
      body_(std::move(body)),
      gouge_(part_, job.tools, {limits, part_.part().blank_top()}),
      check_(job, machine, limits, part_, body_, gouge_, surface_options(grid)) {
  check_.plan_anew = process::planned_once([this](std::size_t operations) -> process::PlannedMotions {
    const auto first = planned_operations_.begin();
    auto planned = plan::plan_milling(part_, job_.tools, {first, first + std::ptrdiff_t(operations)}, options_);
    if (auto* refusal = planned.refused()) return std::move(refusal->diagnostic);
    std::vector<path::ToolMotion> motions;
    for (const path::ClPath& path : planned.value().paths) {
      const auto own = analytic::GougeCheck::motions_of(path);
      motions.insert(motions.end(), own.begin(), own.end());
    }
    return motions;
  });
}

/// Modifications that bend a flank or a fillet so hollow that the ball of an operation no longer fits, where it would
/// fit the plain one.
std::optional<Diagnostic> Milling::ball_in_hollow() const {
  for (std::size_t n = 0; n < job_.operations.size(); ++n) {
    const path::MillingOperation& op = job_.operations[n];
    if (op.type != path::OperationType::finishing && op.type != path::OperationType::semi_finishing) continue;
    const double R = job_.tools[std::size_t(op.tool)].radius_mm() + op.allowance_mm;
    for (const auto& [zone, form] : modified_)
      for (const auto& [region, what, most, plain] :
           {std::tuple(path::Region::flank, "flank", form.hollow_flank, form.plain_hollow_flank_mm),
            {path::Region::fillet, "fillet", form.hollow_fillet, form.plain_hollow_fillet_mm}}) {
        if (!op.regions[region] || most.value >= R || plain < R) continue;
        return process::located(
            job_, fmt::format("operation[{}].tool", n),
            fail("operation {}: the modifications make {} {:+d} of zone {} hollow with a radius of {:.4f} mm at radius "
                 "{:.4f} mm, height {:.4f} mm (plain: {:.4f} mm at least): a ball of {:.4f} mm does not fit; a smaller "
                 "ball, less amount or more length would do",
                 n, what, most.side, zone, most.value, most.radius_mm, most.height_mm, plain, R));
      }
  }
  return std::nullopt;
}

Status Milling::plan(app::StageClock& clock, app::Progress& progress) {
  if (auto refused = ball_in_hollow()) return std::move(*refused);
  plan::Options options = options_;
  options.stage = [&](const std::string& name, const std::function<void()>& work) { clock.run(name, work); };
  auto planned = clock.run("plan", [&] {
    return plan::plan_milling(part_, job_.tools, planned_operations_, options,
                              [&](const std::string& text) { progress.show(text); });
  });
  if (auto* refusal = planned.refused()) return process::located(job_, refusal->key, std::move(refusal->diagnostic));
  plan_ = std::move(planned).value();
  process::take_ways(planned_operations_, flank_ways());
  check_.shortened = shortened_passes(plan_);
  return Ok{};
}

std::vector<const path::ClPath*> Milling::paths() const {
  std::vector<const path::ClPath*> out;
  for (const auto& path : plan_.paths) out.push_back(&path);
  return out;
}

std::vector<report::PassReport> Milling::passes() const {
  std::vector<report::PassReport> out;
  for (std::size_t n = 0; n < plan_.lines.size(); ++n)
    if (plan_.lines[n]) add_side_passes(*plan_.lines[n], int(n), out);
  return out;
}

std::vector<report::FlankWaysReport> Milling::flank_ways() const {
  std::vector<report::FlankWaysReport> out;
  const double teeth = part_.part().teeth();
  for (const plan::FlankChoice& choice : plan_.choices)
    for (const line::FlankWays& w : choice.ways) {
      report::FlankWaysReport& row = out.emplace_back();
      row.operation = choice.operation;
      row.zone = w.zone;
      row.flank = w.side;
      for (const line::Way& tried : w.strips) row.tried.push_back({tried.strips, tried.misfit_mm, tried.given_up});
      row.side_minutes = teeth * w.minutes;
      row.ball_passes = w.ball_passes;
      row.ball_minutes = teeth * w.ball_minutes;
      row.by_ball = choice.by_ball;
      row.refused = choice.refused;
    }
  return out;
}

std::vector<report::EngagementReport> Milling::engagement() const {
  std::vector<report::EngagementReport> out;
  for (const plan::EngagementTrack& t : plan_.engagement)
    out.push_back(
        {t.operation, t.way_mm, t.engaged_rad, t.chip_mm, t.feed_mm_min, t.step_over_mm, t.beside_rad, t.opening_mm});
  return out;
}

std::vector<std::string> Milling::advice() const {
  if (plan_.paths.empty() || job_.operations.front().type != path::OperationType::roughing) return {};
  const path::MillingOperation& first = job_.operations.front();
  const tool::ToolAssembly& tool = job_.tools[std::size_t(first.tool)];
  const double admitted = plan::first_ball_mm(part_, first.allowance_mm, ball::reach_of(job_.tools));
  if (tool.diameter_mm >= kSmallFirst * admitted) return {};
  return {
      fmt::format("operation 0 roughs with tool {}, {:g} mm; the upper half of the tooth spaces, where most of "
                  "the material is, admits a ball of {:.2f} mm",
                  tool.number, tool.diameter_mm, admitted)};
}

rest::Excess Milling::roughed() const {
  std::vector<rest::Excess> removed;
  for (const path::ClPath& path : plan_.paths) {
    if (job_.operations[std::size_t(path.operation)].type != roughing()) continue;
    const auto one = std::make_shared<const cut::Removed>(analytic::GougeCheck::motions_of(path),
                                                          tool::proof_tool(job_.tools[std::size_t(path.tool)]),
                                                          part_.part().highest_z());
    removed.emplace_back([one](const Vec3& p, double cap) { return one->excess(p, cap); });
  }
  return rest::excess_of(std::move(removed));
}

std::vector<proof::LedgerEntry> Milling::ledger(const joints::AxisProgram& program, const process::ProgramProof& proof,
                                                double blend_mm) const {
  return milled::ledger({part_, plan_, job_.tools, job_.operations, check_.surface}, program, proof,
                        {blend_mm, limits_.proof_mm, options_.line_bias_mm, *job_.setup});
}

}  // namespace toothpath::milled
