#include "app/process/milled/proof.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "app/base/units.h"
#include "app/process/milled/unreached.h"
#include "app/process/proof_limits.h"
#include "cam/ball/plan.h"
#include "cam/path/asked_stock.h"
#include "cam/path/motion_blend.h"
#include "cam/proof/rapid_clearance.h"
#include "cam/proof/roof.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"
#include "geometry/tooth_space/zone_next_to.h"

namespace toothpath::milled {
namespace {

constexpr double kBallMotionTolerance =
    1e-4;  // mm and rad: proven distance of a read-back motion from its straight line

void judge_gouge(const proof::GougeResult& gouge, const analytic::GougeCheck& check, double tolerance,
                 std::vector<std::string>& reasons) {
  if (check.passes(gouge)) return;
  // Where the tool cuts too deep, or else where it may.
  const auto cuts = std::find_if(gouge.worst.begin(), gouge.worst.end(),
                                 [](const proof::WorstPlace& w) { return tool::cuts(w.body); });
  const bool seen = gouge.measured_mm > tolerance || cuts == gouge.worst.end();
  const proof::WorstPlace &place = seen ? gouge.deepest : *cuts, &body = gouge.closest;
  if (gouge.bound_mm > tolerance)
    reasons.push_back(
        fmt::format("gouge: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um; {} against {}, operation {}, line "
                    "{}, r {:.3f} mm, z {:.3f} mm",
                    gouge.measured_mm * 1000, gouge.bound_mm * 1000, tolerance * 1000, place.body, place.patch,
                    place.operation, place.line, place.radius_mm, place.height_mm));
  if (gouge.clearance_mm < gouge.required_clearance_mm)
    reasons.push_back(
        fmt::format("clearance of shank and holder: {:.4f} mm is below {:.4f} mm; {} against {}, operation {}, line {}",
                    gouge.clearance_mm, gouge.required_clearance_mm, body.body, body.patch, body.operation, body.line));
  if (!gouge.rapids_clear) reasons.push_back("a rapid passes through the blank");
  if (reasons.empty()) reasons.push_back("the gouge check does not pass");
}

using SeeMotions =
    std::function<void(const std::vector<path::ToolMotion>& motions, std::span<const proof::LikeMotion> likes)>;

/// Teeth that are followed one by one come twice: what is like no other, then what is like that.
/// @param see  gets all motions, tooth by tooth where they come so
proof::GougeResult gouge_of(const analytic::GougeCheck& check, process::ProgramProof& program,
                            const std::vector<int>& tool_of_operation, const SeeMotions& see) {
  if (!program.each_tooth) {
    see(program.motions, program.likes);
    return check.check(program.motions, tool_of_operation, program.likes);
  }
  const WorkShare all{double(program.tooth_motions)};
  analytic::GougeStream stream(check, tool_of_operation, program.likes_follow);
  std::uint32_t firsts = 0;
  Status made = program.each_tooth(process::TeethWanted::whole, [&](auto&& motions, auto likes, bool first) {
    if (!first) see(motions, likes);
    auto like = likes.begin();
    for (std::size_t k = 0; k < motions.size(); ++k) {
      if (like != likes.end() && like->motion == k) ++like;
      else stream.own(motions[k], first ? std::optional(firsts++) : std::nullopt);
    }
  });
  if (made && program.likes_follow)
    made = program.each_tooth(process::TeethWanted::cuts, [&](auto&& motions, auto likes, bool) {
      for (const proof::LikeMotion& like : likes) stream.like(motions[like.motion], like);
    });
  if (!made) program.reasons.push_back(made.error().message);
  return stream.finish();
}

/// What may stand above the allowance of a line-milled flank, whether or not others follow.
void judge_line_flank(const cut::CutSurface& surface, const path::MillingOperation& op, std::size_t n,
                      std::vector<std::string>& reasons) {
  const double most = proof::most_left_mm(op, path::Region::flank),
               stands = surface.most_in_mm[n][path::Region::flank] - op.allowance_mm;
  if (stands > most)
    reasons.push_back(
        fmt::format("operation {}: {:.2f} um stand on a flank above the allowance of {:.4f} mm, limit {:.2f} "
                    "um (left {:.2f}, chord {:.2f}, margin {:.2f})",
                    n, stands * 1000, op.allowance_mm, most * 1000, op.most_misfit_mm() * 1000,
                    op.chord_tolerance_mm * 1000, proof::kBallMargin * 1000));
}

/// What the finishing operations leave in each region.
void judge_finished(const cut::CutSurface& surface, const job::Job& job, const proof::ProofLimits& limits,
                    std::vector<std::string>& reasons) {
  std::string said;
  for (const path::Region region : path::kRegions) {
    const auto& limit = limits.left_in_mm[region];
    const double left = surface.finished_in_mm[region];
    if (!limit || left <= *limit) continue;
    const path::MillingOperation& op = job.operations[*path::finisher_of(job.operations, region)];
    const bool side = op.type == path::OperationType::line_milling;
    said += fmt::format(
        "{}{:.2f} um on the {} after the last operation, limit {:.2f} um ({} {:.2f}, chord {:.2f}, margin "
        "{:.2f})",
        said.empty() ? "left material: " : "; ", left * 1000, to_string(region), *limit * 1000,
        side ? "left" : "scallop", (side ? op.most_misfit_mm() : op.scallop_in(region)) * 1000,
        op.chord_tolerance_mm * 1000, proof::kBallMargin * 1000);
  }
  if (!said.empty()) reasons.push_back(std::move(said));
}

/// Stock that must stand in a region after operation n: what was asked of the region last, or less where an operation
/// since then was allowed less. It may run out of its own regions, there too it keeps its own allowance.
double asked_stock(const job::Job& job, std::size_t n, path::Region region) {
  std::size_t last = n;
  if (!job.operations[n].regions[region]) last = path::last_before(job.operations, n, region).value_or(n);
  double least = job.operations[last].allowance_mm;
  for (std::size_t i = last; i <= n; ++i) least = std::min(least, job.operations[i].allowance_mm);
  return least;
}

/// What a finishing operation may leave, on every point that its ball can reach: the cusps, the chords and a
/// micrometre.
void judge_surface(const cut::CutSurface& surface, const job::Job& job, const proof::ProofLimits& limits,
                   std::vector<std::string>& reasons) {
  for (const proof::ExcessResult& after : surface.operations) {
    const auto n = static_cast<std::size_t>(after.operation);
    const path::MillingOperation& op = job.operations[n];
    if (after.points == 0) continue;
    // The side of a mill is asked for the flanks; its end runs through what is left in fillets and root.
    const bool side = op.type == path::OperationType::line_milling;
    if (side) judge_line_flank(surface, op, n, reasons);
    std::optional<path::Region> thin;
    double lacks = 0;
    for (const path::Region region : path::kRegions) {
      if (side && region != path::Region::flank) continue;
      const double least = surface.least_in_mm[n][region],
                   lack = path::kAskedStock * asked_stock(job, n, region) - least;
      if (op.allowance_mm > 0 && lack > lacks) lacks = lack, thin = region;
    }
    if (!thin) continue;
    const double allowance = asked_stock(job, n, *thin);
    reasons.push_back(fmt::format(
        "operation {}: the least stock left on the {} is {:.4f} mm, below {:.4f} mm ({} of the allowance {:.4f})", n,
        to_string(*thin), surface.least_in_mm[n][*thin], path::kAskedStock * allowance, path::kAskedStock, allowance));
  }
  judge_finished(surface, job, limits, reasons);
}

/// How far above the tip a mill cuts, mm: by as much a turned axis moves what it removes.
double reach_of(const tool::ProofTool& tool) {
  if (tool.ball_mill) return tool.ball_mill->radius_mm();  // what it removes is told by its centre
  double reach = 0;
  for (const tool::RoundedFrustum& body : tool.cutting) reach = std::max(reach, body.core.to + body.round);
  return reach;
}

report::Finding scallop_of(const proof::ScallopResult& scallop) {
  report::Finding finding;
  finding.key = "scallop_um";
  finding.details = {{"requested", app::um(scallop.requested_mm)},
                     {"reached_min", app::um(scallop.reached_min_mm)},
                     {"reached_max", app::um(scallop.reached_max_mm)},
                     {"share_within", scallop.share_within},
                     {"fillet_max", app::um(scallop.fillet_max_mm)}};
  return finding;
}

/// What stands on each region of the finished surface.
report::Finding left_of(const cut::CutSurface& surface) {
  const auto& left = surface.finished_in_mm;
  report::Finding finding;
  finding.key = "left_um";
  finding.label = "left on the regions";
  for (const path::Region region : path::kRegions) {
    finding.details.emplace_back(to_string(region), app::um(left[region]));
    finding.text +=
        fmt::format("{}{} {:.2f}", finding.text.empty() ? "" : ", ", to_string(region), app::um(left[region]));
  }
  finding.unit = "um";
  return finding;
}

}  // namespace

MilledCheck::MilledCheck(const job::Job& job, const machines::Machine& machine, const proof::ProofLimits& limits,
                         const analytic::GearDistance& part, const GearBody& body, const analytic::GougeCheck& check,
                         const cut::CutSurfaceOptions& grid)
    : job_(job),
      machine_(machine),
      limits_(limits),
      part_(part),
      body_(body),
      check_(check),
      tools_(tool::proof_tools(job.tools)),
      meter_(part, job.operations, tools_, grid) {}

int MilledCheck::teeth() const { return part_.part().teeth(); }

double MilledCheck::motion_tolerance() const { return kBallMotionTolerance; }

double MilledCheck::pitches_from_space_0(const Vec3& tip) const {
  const double s = part_.part().chart().along(tip);
  const int zone = tooth_space::zone_next_to(part_.part(), s);
  return (std::atan2(tip.y(), tip.x()) - part_.space_azimuth(zone, s)) / part_.space(zone).outline().pitch;
}

/// The cylinder that the axis program promised to avoid; on a cone engaging rapids pass inside of it, above the blank.
Status MilledCheck::rapids_clear(const readback::OperationTrace& trace, const readback::NcControl& control) const {
  proof::RapidObstacle obstacle = readback::obstacle_of(body_.links);
  obstacle.roof = body_.rapids.roof;
  return check_rapids_outside(trace, control, machine_, *job_.setup, obstacle, job_.tools);
}

bool MilledCheck::may_cut(const path::ToolMotion& motion) const {
  const tool::ProofTool& used = tool_of(motion.operation);
  return !(used.ball_mill ? proof::prove_rapid(motion, *used.ball_mill, body_.rapids)
                          : proof::prove_rapid(motion, used, body_.rapids))
              .clear;
}

/// What finishes a region last.
bool MilledCheck::measures(int operation) const {
  return std::any_of(std::begin(path::kRegions), std::end(path::kRegions), [&](path::Region region) {
    return path::finisher_of(job_.operations, region) == std::size_t(operation);
  });
}

/// Later teeth that are no copies of the first one, by what may stand on them.
class MilledCheck::OtherTeeth {
 public:
  OtherTeeth(const process::ProgramProof& program, const MilledCheck& check) : check_(check) {
    for (const process::ToothCut& other : program.other_teeth) {
      if (other.cuts_nothing() || !check.measures(other.operation)) continue;
      double& away = away_[other.tooth];
      away = std::max(away, other.again.away(reach_of(check.tool_of(other.operation))));
      if (other.again.missing) unlike_.emplace(other.tooth, told(other));
      else watch_mm_ = std::max(watch_mm_, away);
    }
  }
  /// The most that one of them may be away from the first one, where all of that is cut again.
  [[nodiscard]] double watch_mm() const { return watch_mm_; }

  /// The first tooth is measured: where is nearly as much left as may be?
  void measured(const cut::CutSurface& surface) {
    for (const auto& [tooth, away] : away_)
      if (!unlike_.contains(tooth) && !within(surface, away)) near_.emplace(tooth, cut::LeftOnTooth(surface.watched));
  }
  void see(const std::vector<path::ToolMotion>& motions) {
    if (near_.empty()) return;
    std::map<std::pair<int, int>, std::vector<path::ToolMotion>> cuts;  // by tooth and operation
    for (const path::ToolMotion& m : motions)
      if (!m.rapid && near_.contains(m.tooth) && check_.measures(m.operation))
        cuts[{m.tooth, m.operation}].push_back(m);
    for (auto& [key, own] : cuts)
      near_.at(key.first).add(process::in_space_0(std::move(own), check_.teeth()), check_.tool_of(key.second),
                              check_.part_.part().highest_z());
  }
  /// Those that must be measured by themselves, and what is missing there; empty: nothing is.
  [[nodiscard]] std::map<int, std::string> unlike() const {
    std::map<int, std::string> out = unlike_;
    for (const auto& [tooth, left] : near_)
      if (!left.within()) out.emplace(tooth, std::string());
    return out;
  }

 private:
  /// No more can stand than on the first tooth and the way from there.
  [[nodiscard]] bool within(const cut::CutSurface& surface, double away) const {
    for (const path::Region region : path::kRegions)
      if (const auto& limit = check_.limits_.left_in_mm[region])
        if (surface.finished_in_mm[region] <= *limit && surface.finished_in_mm[region] + away > *limit) return false;
    return true;
  }

  const MilledCheck& check_;
  std::map<int, double> away_;
  std::map<int, std::string> unlike_;
  std::map<int, cut::LeftOnTooth> near_;
  double watch_mm_ = 0;
};

const tool::ProofTool& MilledCheck::tool_of(int operation) const {
  return tools_[std::size_t(job_.operations[std::size_t(operation)].tool)];
}

void MilledCheck::judge_unlike(process::ProgramProof& program, const OtherTeeth& others) {
  const std::map<int, std::string> unlike = others.unlike();
  std::set<int> teeth;
  for (const auto& [tooth, why] : unlike) teeth.insert(tooth);
  std::size_t refused = 0;
  for (auto& [tooth, cuts] : process::cuts_of(program, teeth)) {
    if (refused > process::kTeethTold) break;  // it is not verified at any rate
    cut::CutSurface own = meter_.measure(process::in_space_0(std::move(cuts), this->teeth()), 0);
    std::vector<std::string> reasons;
    judge_surface(own, job_, limits_, reasons);
    judge_unreached(own.unreached, job_.verify.unreached_mm, reasons);
    const std::string& why = unlike.at(tooth);
    if (!reasons.empty() && !why.empty()) reasons.push_back(why);
    if (!reasons.empty() && ++refused <= process::kTeethTold)
      for (const std::string& reason : reasons)
        program.reasons.push_back(reason == why ? why : fmt::format("tooth {}: {}", tooth, reason));
    if (own.finished.max_mm > surface.finished.max_mm) surface = std::move(own);
  }
  if (refused > process::kTeethTold) program.reasons.emplace_back("so it is with more teeth");
}

/// By what the job asks, and where that says nothing of the stock by a plan made anew.
process::LoadJudge MilledCheck::load_judge() const {
  process::LoadQuery query{.job = job_,
                           .in_blank = [&](const Vec3& p) { return part_.part().in_blank(p); },
                           .top_mm = part_.part().highest_z(),
                           .chart = part_.part().chart()};
  for (std::size_t n = 0; n < job_.operations.size(); ++n) {
    query.mills.push_back(tool::profile_of(job_.tools[std::size_t(job_.operations[n].tool)]));
    query.bodies.push_back(tool_of(int(n)));
    query.stock_before_mm.push_back(ball::stock_before(job_.operations, job_.tools, n));
  }
  query.plan = plan_anew;
  return process::LoadJudge(std::move(query));
}

/// A web beside the teeth is no part of the tooth spaces: nothing comes as low as it stands.
void MilledCheck::meet(const readback::OperationTrace&, std::span<const path::ToolMotion> motions,
                       const readback::NcControl&) {
  if (!body_.web_z || !into_web_.empty()) return;
  const proof::Roof web(part_.part().chart(), *body_.web_z);
  for (const path::ToolMotion& m : motions) {
    if (m.rapid) continue;  // they keep clear of all of the body
    const tool::ProofTool& tool = tool_of(m.operation);
    std::vector<tool::RoundedFrustum> bodies = tool.cutting;
    for (const tool::Frustum& body : tool.bodies) bodies.push_back({body, 0});
    for (const tool::RoundedFrustum& body : bodies) {
      const double reach = std::hypot(body.core.to + body.round, body.widest()),
                   over = web.over(body, m.tip_from, m.axis_from, m.tip_to, m.axis_to) - path::line_slack(m, reach, 1);
      if (over >= 0) continue;
      into_web_ = fmt::format(
          "line {}: the {} of tool {} comes {:.4f} mm below z {:.4f} mm, where the web between the bore and the teeth "
          "stands (stock.bore_diameter)",
          m.line, body.core.body, tool.number, -over, *body_.web_z);
      return;
    }
  }
}

const cut::CutSurface& MilledCheck::measured(const std::vector<path::ToolMotion>& firsts, double watch_mm) {
  const auto same_way = [](const path::ToolMotion& a, const path::ToolMotion& b) {
    return a.tip_from == b.tip_from && a.tip_to == b.tip_to && a.axis_from == b.axis_from && a.axis_to == b.axis_to &&
           a.operation == b.operation && a.tooth == b.tooth && a.rapid == b.rapid;
  };
  if (!last_ || last_->watch_mm != watch_mm ||
      !std::equal(firsts.begin(), firsts.end(), last_->motions.begin(), last_->motions.end(), same_way))
    last_ = Measured{firsts, watch_mm, meter_.measure(firsts, watch_mm)};
  return last_->surface;
}

void MilledCheck::judge(process::ProgramProof& program, app::StageClock& clock) {
  std::vector<int> tool_of_operation;
  for (const auto& operation : job_.operations) tool_of_operation.push_back(operation.tool);
  OtherTeeth others(program, *this);
  process::LoadedOtherwise loaded(program, *this);
  const std::vector<path::ToolMotion> firsts = process::first_in_space_0(program.motions, teeth());
  surface = clock.run("cut surface", [&] { return measured(firsts, others.watch_mm()); });
  std::optional<process::LoadJudge> load;
  if (program.others_text)
    clock.run("engagement", [&] {
      load.emplace(load_judge());
      load->judge(firsts, program.reasons);
    });
  others.measured(surface);
  program.gouge = clock.run("proof of the program", [&] {
    return gouge_of(check_, program, tool_of_operation, [&](const auto& motions, auto likes) {
      others.see(motions);
      loaded.see(motions, likes);
    });
  });
  judge_gouge(program.gouge, check_, limits_.gouge_mm, program.reasons);
  if (!into_web_.empty()) program.reasons.push_back(into_web_);
  judge_surface(surface, job_, limits_, program.reasons);
  clock.run("cut surface", [&] { judge_unlike(program, others); });
  if (load)
    clock.run("engagement", [&] {
      load->judge_by_plan(firsts, program.reasons, program.warnings);
      loaded.judge(program, *load);
    });
  if (!program.reasons.empty()) program.reasons.insert(program.reasons.end(), shortened.begin(), shortened.end());
  if (!program.reasons.empty())
    if (const auto coarse = process::coarse_words(job_, machine_, body_.links.radius_mm))
      program.reasons.push_back(*coarse);
  judge_unreached(surface.unreached, job_.verify.unreached_mm, program.reasons);
  program.excess = surface.operations;
  program.finished = surface.finished;
  program.surface = std::move(surface.grids);
  program.findings.push_back(unreached_of(surface.unreached));
  if (path::finisher_of(job_.operations, path::Region::flank) !=
      path::finisher_of(job_.operations, path::Region::fillet))
    program.findings.push_back(left_of(surface));
  if (surface.scallop.requested_mm > 0) program.findings.push_back(scallop_of(surface.scallop));
}

}  // namespace toothpath::milled
