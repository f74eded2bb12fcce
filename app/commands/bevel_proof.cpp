#include "app/commands/bevel_proof.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/commands/program_motions.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kMotionTolerance = 5e-5;  // mm and rad: proven distance of a read-back motion from its straight line
constexpr double kWallAllowance = 1.5e-3;  // mm above the chord tolerance that a finished wall may stand proud
constexpr double kRoundedLinear = 2.5e-3;  // mm and deg: an axis that changes less stands still (words of three decimals)
constexpr double kAlongAxis = 0.05;        // a move with less across the axis, as a share, is an engage or retract

/// Chord tolerance of the walls: of the last finishing operation.
std::optional<double> finishing_chord(const Job& job) {
  std::optional<double> chord;
  for (const auto& operation : job.operations)
    if (operation.type == OperationType::finger_finishing) chord = operation.chord_tolerance_mm;
  return chord;
}

void judge(const Job& job, const FingerCheckResult& v, std::vector<std::string>& reasons) {
  const GougeResult& g = v.gouge;
  const double tolerance = job.verify.gouge_tolerance_mm;
  const WorstPlace& place = g.worst.empty() ? g.deepest : g.worst.front();
  const auto told = [](const WorstPlace& p) {
    return fmt::format("{} against {}, operation {}, tooth {}, line {}, r {:.3f} mm, z {:.3f} mm", p.body, p.patch, p.operation, p.tooth, p.line, p.radius_mm,
                       p.height_mm);
  };
  const std::string where = told(place);
  if (!(g.bound_mm <= tolerance))
    reasons.push_back(fmt::format("gouge: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um; {}", g.measured_mm * 1000, g.bound_mm * 1000,
                                  tolerance * 1000, where));
  if (!(g.clearance_mm >= g.required_clearance_mm))
    reasons.push_back(fmt::format("clearance of shank and holder: {:.4f} mm is below {:.4f} mm; {}", g.clearance_mm, g.required_clearance_mm, told(g.closest)));
  if (!g.rapids_clear) reasons.push_back("a rapid passes through the blank; " + where);
  if (v.ridge.requested_mm > 0 && !(v.ridge.reached_mm <= v.ridge.requested_mm))
    reasons.push_back(fmt::format("ridge: {:.4f} mm is left on the root at cone distance {:.3f} mm, asked {:.4f} mm", v.ridge.reached_mm,
                                  v.ridge.cone_distance_mm, v.ridge.requested_mm));
  if (const auto chord = finishing_chord(job); chord && !(v.finished.bound_mm <= *chord + kWallAllowance))
    reasons.push_back(fmt::format("material left on the walls: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um", v.finished.max_mm * 1000,
                                  v.finished.bound_mm * 1000, (*chord + kWallAllowance) * 1000));
}

/// The worse of two teeth, field by field.
void take_worse(FingerCheckResult& all, FingerCheckResult one) {
  GougeResult &a = all.gouge, &b = one.gouge;
  a.measured_mm = std::max(a.measured_mm, b.measured_mm);
  if (b.bound_mm > a.bound_mm) a.bound_mm = b.bound_mm, a.bound_line = b.bound_line;
  if (b.clearance_mm < a.clearance_mm) a.closest = b.closest;
  a.clearance_mm = std::min(a.clearance_mm, b.clearance_mm);
  a.clearance_measured_mm = std::min(a.clearance_measured_mm, b.clearance_measured_mm);
  a.rapids_clear = a.rapids_clear && b.rapids_clear;
  a.motions += b.motions;
  a.distance_queries += b.distance_queries;
  if (b.deepest.depth_mm > a.deepest.depth_mm) a.deepest = b.deepest;
  a.worst.insert(a.worst.end(), b.worst.begin(), b.worst.end());
  std::stable_sort(a.worst.begin(), a.worst.end(), [](const WorstPlace& x, const WorstPlace& y) { return x.depth_mm > y.depth_mm; });
  if (a.worst.size() > 20) a.worst.resize(20);
  all.root_gouge_mm = std::max(all.root_gouge_mm, one.root_gouge_mm);
  all.tilt_rad = std::max(all.tilt_rad, one.tilt_rad);
  all.wall_excess_bound_mm = std::max(all.wall_excess_bound_mm, one.wall_excess_bound_mm);
  if (one.ridge.reached_mm > all.ridge.reached_mm) all.ridge = one.ridge;
  if (one.finished.bound_mm > all.finished.bound_mm) {
    all.finished = one.finished;
    all.operations = one.operations;
    all.walls = one.walls;
  }
}

/// Teeth that are not copies of the first are proven one by one.
FingerCheckResult verify_teeth(const FingerGougeCheck& check, const std::vector<ToolMotion>& motions) {
  std::map<int, std::vector<ToolMotion>> teeth;
  std::set<int> cut;
  for (const auto& m : motions) {
    teeth[m.tooth].push_back(m);
    if (!m.rapid) cut.insert(m.tooth);
  }
  if (cut.size() <= 1) return check.verify(motions);
  std::optional<FingerCheckResult> all;
  for (auto& [tooth, part] : teeth) {
    FingerCheckResult one = check.verify(part);
    if (!all) all = std::move(one);
    else if (cut.contains(tooth)) take_worse(*all, std::move(one));
    else all->gouge.rapids_clear = all->gouge.rapids_clear && one.gouge.rapids_clear;
  }
  return std::move(*all);
}

MovingAxes moving_axes(const ReadBack& read, const std::vector<ToolMotion>& motions, const NcControl& control) {
  std::set<std::pair<int, int>> along_path;  // operation and line
  for (const auto& m : motions) {
    const Vec3 d = m.tip_to - m.tip_from, u = (m.axis_from + m.axis_to).normalized();
    if (!m.rapid && (d - d.dot(u) * u).norm() > kAlongAxis * d.norm()) along_path.emplace(m.operation, m.line);
  }
  MovingAxes out;
  std::array<bool, 5> any{};
  for (const auto& operation : read.operations)
    for (std::size_t i = 1; i < operation.moves.size(); ++i) {
      const ExecutedMove &from = operation.moves[i - 1], &to = operation.moves[i];
      if (to.rapid || !to.known || !along_path.contains({to.operation, to.line})) continue;
      std::size_t n = 0;
      for (std::size_t k = 0; k < 5; ++k)
        if (control.letters[k] && std::abs(to.joints[k] - from.joints[k]) > kRoundedLinear) any[k] = true, ++n;
      out.simultaneous = std::max(out.simultaneous, n);
    }
  for (std::size_t k = 0; k < 5; ++k)
    if (any[k]) out.letters += control.letters[k];
  return out;
}

}  // namespace

Tolerances proof_tolerances(const Job& job) {
  Tolerances tolerances;
  tolerances.gouge_mm = job.verify.gouge_tolerance_mm;
  if (job.verify.clearance_mm) tolerances.clearance_mm = *job.verify.clearance_mm;
  return tolerances;
}

Result<BevelProof> prove_bevel_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine,
                                       const BevelGear& gear, const FingerGougeCheck& check, std::span<const ClPath* const> paths,
                                       const PathTolerance& path, StageClock& clock) {
  auto read = motions_of_program(text, file, job, machine, gear.parameters().teeth, kMotionTolerance, kMotionTolerance, clock);
  if (!read) return read.error();
  BevelProof proof;
  proof.read = std::move(read->read);
  proof.motions = std::move(read->motions);
  proof.result = clock.run("proof of the program", [&] { return verify_teeth(check, proof.motions); });
  proof.moving = moving_axes(proof.read, proof.motions, read->control);
  judge(job, proof.result, proof.reasons);
  if (paths.empty()) return proof;
  proof.path_tolerance_mm = path.mm + 2 * kMotionTolerance;
  proof.comparison = compare_with_paths(proof.motions, paths, proof.path_tolerance_mm, path.rad + 2 * kMotionTolerance, clock, proof.reasons);
  return proof;
}

std::vector<DirectionChoice> directions_of(const BevelGear& g, const Job& job, const BevelProof& proof) {
  std::vector<DirectionChoice> directions;
  static constexpr const char* kCount[] = {"no", "one", "two", "three", "four", "five"};
  for (const auto& operation : proof.read.operations) {
    if (operation.operation < 0 || static_cast<std::size_t>(operation.operation) >= job.operations.size()) continue;
    for (std::size_t zone = 0; zone < g.halves().size(); ++zone) {
      DirectionChoice d;
      d.operation = operation.operation;
      d.zone = static_cast<int>(zone);
      d.axis = g.axis(0);
      d.lean_rad = kPi / 2 - g.delta();
      d.clearance_mm = proof.result.gouge.clearance_mm;
      d.explanation = fmt::format("normal to the pitch cone, {:.4f} deg to the gear axis, to within {:.4f} deg: {} simultaneous axes ({}) plus fixed tilt",
                                  degrees(d.lean_rad), degrees(proof.result.tilt_rad), kCount[std::min<std::size_t>(5, proof.moving.simultaneous)],
                                  proof.moving.letters);
      directions.push_back(std::move(d));
    }
  }
  return directions;
}

}  // namespace toothpath
