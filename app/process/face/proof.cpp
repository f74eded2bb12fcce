#include "app/process/face/proof.h"

#include <algorithm>

#include "app/base/units.h"
#include "app/process/face/unreached.h"
#include "app/process/proof_limits.h"
#include "geometry/base/work_share.h"

namespace toothpath::face {
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

/// Teeth that are followed one by one come twice: what is like no other, then what is like that.
proof::GougeResult gouge_of(const analytic::GougeCheck& check, process::ProgramProof& program,
                            const std::vector<int>& tool_of_operation) {
  if (!program.each_tooth) return check.check(program.motions, tool_of_operation, program.likes);
  const WorkShare all{double(program.tooth_motions)};
  analytic::GougeStream stream(check, tool_of_operation, program.likes_follow);
  std::uint32_t firsts = 0;
  Status made = program.each_tooth(process::TeethWanted::whole, [&](auto&& motions, auto likes, bool first) {
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

/// The least stock after an operation, as a share of its allowance.
constexpr double kLeastAllowance = 0.8;

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
    const double allowance = op.allowance_mm, least = side ? surface.least_in_mm[n][path::Region::flank] : after.min_mm;
    if (side) judge_line_flank(surface, op, n, reasons);
    if (allowance > 0 && least < kLeastAllowance * allowance)
      reasons.push_back(
          fmt::format("operation {}: the least stock left{} is {:.4f} mm, below {:.4f} mm ({} of the allowance {:.4f})",
                      n, side ? " on a flank" : "", least, kLeastAllowance * allowance, kLeastAllowance, allowance));
  }
  judge_finished(surface, job, limits, reasons);
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

joints::ClearanceBody clearance_body(const face_gear::FaceGear& gear) {
  double lowest = gear.lowest_root();
  if (gear.rings().size() > 1) lowest = std::min(lowest, gear.groove_floor());
  return {gear.outer_radius(), lowest - 2.5 * gear.parameters().module_mm, gear.blank_top()};
}

FaceGearCheck::FaceGearCheck(const job::Job& job, const machines::Machine& machine, const proof::ProofLimits& limits,
                             const analytic::GearDistance& part, const analytic::GougeCheck& check,
                             const cut::CutSurfaceOptions& grid)
    : job_(job), machine_(machine), limits_(limits), part_(part), check_(check), grid_(grid) {}

int FaceGearCheck::teeth() const { return part_.gear().parameters().teeth; }

double FaceGearCheck::motion_tolerance() const { return kBallMotionTolerance; }

/// The cylinder that the axis program promised to avoid.
Status FaceGearCheck::rapids_clear(const readback::OperationTrace& trace, const readback::NcControl& control) const {
  return check_rapids_outside(trace, control, machine_, *job_.setup, clearance_body(part_.gear()), job_.tools);
}

void FaceGearCheck::meet(const readback::OperationTrace&, std::span<const path::ToolMotion>,
                         const readback::NcControl&) {
}  // all that is said of a face gear holds for the teeth that are proven

void FaceGearCheck::judge(process::ProgramProof& program, app::StageClock& clock) {
  std::vector<int> tool_of_operation;
  for (const auto& operation : job_.operations) tool_of_operation.push_back(operation.tool);
  program.gouge = clock.run("proof of the program", [&] { return gouge_of(check_, program, tool_of_operation); });
  judge_gouge(program.gouge, check_, limits_.gouge_mm, program.reasons);
  surface = clock.run("cut surface", [&] {
    return cut::measure_cut_surface(part_, program.motions, job_.operations, job_.tools, grid_);
  });
  judge_surface(surface, job_, limits_, program.reasons);
  if (!program.reasons.empty()) program.reasons.insert(program.reasons.end(), shortened.begin(), shortened.end());
  if (!program.reasons.empty())
    if (const auto coarse = process::coarse_words(job_, machine_, part_.gear().outer_radius()))
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

}  // namespace toothpath::face
