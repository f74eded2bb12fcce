#include "app/commands/proof.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/commands/program_motions.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kExcessMargin = 1e-3;  // mm: rounding, axis motion and the grid of the measurement

void judge_gouge(const GougeResult& gouge, const GougeCheck& check, const ProofOptions& options, std::vector<std::string>& reasons) {
  if (check.passes(gouge)) return;
  // Where the tool cuts too deep, or else where it may.
  const auto cuts = std::find_if(gouge.worst.begin(), gouge.worst.end(), [](const WorstPlace& w) { return w.body == "ball" || w.body == "flute"; });
  const bool seen = gouge.measured_mm > options.gouge_tolerance_mm || cuts == gouge.worst.end();
  const WorstPlace &place = seen ? gouge.deepest : *cuts, &body = gouge.closest;
  if (gouge.bound_mm > options.gouge_tolerance_mm)
    reasons.push_back(fmt::format("gouge: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um; {} against {}, operation {}, line {}, r {:.3f} mm, z {:.3f} mm",
                                  gouge.measured_mm * 1000, gouge.bound_mm * 1000, options.gouge_tolerance_mm * 1000, place.body, place.patch,
                                  place.operation, place.line, place.radius_mm, place.height_mm));
  if (gouge.clearance_mm < gouge.required_clearance_mm)
    reasons.push_back(fmt::format("clearance of shank and holder: {:.4f} mm is below {:.4f} mm; {} against {}, operation {}, line {}", gouge.clearance_mm,
                                  gouge.required_clearance_mm, body.body, body.patch, body.operation, body.line));
  if (!gouge.rapids_clear) reasons.push_back("a rapid passes through the blank");
  if (reasons.empty()) reasons.push_back("the gouge check does not pass");
}

/// The least stock after an operation, as a share of its allowance.
constexpr double kLeastAllowance = 0.8;

/// What a finishing operation may leave, on every point that its ball can reach: the cusps, the chords and a micrometre.
void judge_surface(const CutSurface& surface, const Job& job, std::vector<std::string>& reasons) {
  for (const ExcessResult& after : surface.operations) {
    const double allowance = job.operations[static_cast<std::size_t>(after.operation)].allowance_mm;
    if (allowance > 0 && after.points > 0 && after.min_mm < kLeastAllowance * allowance)
      reasons.push_back(fmt::format("operation {}: the least stock left is {:.4f} mm, below {:.4f} mm ({} of the allowance {:.4f})", after.operation,
                                    after.min_mm, kLeastAllowance * allowance, kLeastAllowance, allowance));
  }
  const MillingOperation& last = job.operations.back();
  if (last.type != OperationType::finishing) return;
  const double limit = last.scallop_mm + last.chord_tolerance_mm + kExcessMargin;
  if (surface.finished.max_mm <= limit) return;
  reasons.push_back(fmt::format("left material: {:.2f} um after the last operation, limit {:.2f} um (scallop {:.2f}, chord {:.2f}, margin {:.2f})",
                                surface.finished.max_mm * 1000, limit * 1000, last.scallop_mm * 1000, last.chord_tolerance_mm * 1000,
                                kExcessMargin * 1000));
}


/// Cutting motions of a tooth that are those of the first tooth of the same operation, turned about the gear axis to within
/// `kCopyTolerance`, are left out; the distance found is added to the deviation of the first tooth's motions, so that a bound
/// proven for these holds for all. Rapids, and teeth that differ, are kept as they are.
std::vector<ToolMotion> without_copies(std::vector<ToolMotion> motions, int teeth) {
  constexpr double kCopyTolerance = 5e-4;  // mm: roundings of words of two teeth, with room
  std::map<std::pair<int, int>, std::vector<std::size_t>> cuts;  // operation and tooth -> cutting motions
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!motions[k].rapid) cuts[{motions[k].operation, motions[k].tooth}].push_back(k);
  std::vector<bool> drop(motions.size(), false);
  std::map<int, int> first_tooth;
  for (const auto& m : motions)
    if (!m.rapid) first_tooth.emplace(m.operation, m.tooth);
  for (const auto& [key, indices] : cuts) {
    const auto& [operation, tooth] = key;
    const int reference = first_tooth.at(operation);
    const auto& original = cuts.at({operation, reference});
    if (tooth == reference || indices.size() != original.size()) continue;
    const double turn = -2 * kPi * (tooth - reference) / teeth;
    double shift = 0;
    for (std::size_t k = 0; k < indices.size() && shift <= kCopyTolerance; ++k) {
      const ToolMotion &m = motions[indices[k]], &o = motions[original[k]];
      const double tip = std::max((turned(m.tip_from, turn) - o.tip_from).norm(), (turned(m.tip_to, turn) - o.tip_to).norm());
      const double axis = std::max((turned(m.axis_from, turn) - o.axis_from).norm(), (turned(m.axis_to, turn) - o.axis_to).norm());
      shift = std::max(shift, tip + 1000 * axis);  // the axis also moves shank and holder, less than a metre away
    }
    if (shift > kCopyTolerance) continue;
    for (std::size_t k = 0; k < indices.size(); ++k) {
      ToolMotion& o = motions[original[k]];
      o.deviation_mm = std::max(o.deviation_mm, motions[indices[k]].deviation_mm + shift);
      drop[indices[k]] = true;
    }
  }
  std::vector<ToolMotion> kept;
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (!drop[k]) kept.push_back(motions[k]);
  return kept;
}

}  // namespace

ClearanceBody clearance_body(const FaceGear& gear) {
  double lowest = gear.lowest_root();
  if (gear.rings().size() > 1) lowest = std::min(lowest, gear.groove_floor());
  return {gear.outer_radius(), lowest - 2.5 * gear.parameters().module_mm, gear.blank_top()};
}

Result<ProgramProof> prove_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine,
                                   const GearDistance& part, const GougeCheck& check, const ClearanceBody& body, int teeth, std::span<const ClPath* const> paths,
                                   const ProofOptions& options, StageClock& clock) {
  auto read = motions_of_program(text, file, job, machine, teeth, options.motion_tolerance_mm, options.motion_tolerance_rad, clock);
  if (!read) return read.error();
  ProgramProof proof;
  proof.read = std::move(read->read);
  proof.motions = std::move(read->motions);
  for (const OperationTrace& trace : proof.read.operations)
    if (const auto clear = check_rapids(trace, read->control, machine, *job.setup, body, job.tools); !clear) proof.reasons.push_back(clear.error().message);
  // Teeth that are written out one by one: what is the first tooth again, turned, need not be proven again.
  if (!proof.read.copies.copies && !job.verify.all_teeth)
    proof.motions = clock.run("compare the teeth", [&] { return without_copies(std::move(proof.motions), teeth); });

  std::vector<int> tool_of_operation;
  for (const auto& operation : job.operations) tool_of_operation.push_back(operation.tool);
  proof.gouge = clock.run("proof of the program", [&] { return check.check(proof.motions, tool_of_operation); });
  judge_gouge(proof.gouge, check, options, proof.reasons);
  proof.surface = clock.run("cut surface", [&] { return measure_cut_surface(part, proof.motions, job.operations, job.tools, options.cut_surface); });
  judge_surface(proof.surface, job, proof.reasons);
  if (!paths.empty())
    proof.comparison = compare_with_paths(proof.motions, paths, options.path_tolerance_mm, options.path_tolerance_rad, clock, proof.reasons);
  return proof;
}

}  // namespace toothpath
