#include "app/process/bevel/proof.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "app/base/units.h"
#include "cam/finger/finger_profile.h"
#include "cam/finger/milling.h"
#include "cam/finger/teeth.h"
#include "geometry/base/angle.h"
#include "geometry/bevel_gear/part.h"

namespace toothpath::bevel {
namespace {

constexpr double kRoundedLinear =
    2.5e-3;                          // mm and deg: an axis that changes less stands still (words of three decimals)
constexpr double kAlongAxis = 0.05;  // a move with less across the axis, as a share, is an engage or retract

constexpr double kLoadSag = 0.05;  // mm: the mill as a load asks for it

std::string told(const proof::WorstPlace& p) {
  return fmt::format("{} against {}, operation {}, tooth {}, line {}, r {:.3f} mm, z {:.3f} mm", p.body, p.patch,
                     p.operation, p.tooth, p.line, p.radius_mm, p.height_mm);
}

void judge_teeth(const proof::ProofLimits& limits, const finger::FingerCheckResult& v,
                 std::vector<std::string>& reasons) {
  const proof::GougeResult& g = v.gouge;
  const double tolerance = limits.gouge_mm;
  const proof::WorstPlace& place = g.worst.empty() ? g.deepest : g.worst.front();
  const std::string where = told(place);
  if (!(g.bound_mm <= tolerance))
    reasons.push_back(fmt::format("gouge: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um; {}",
                                  g.measured_mm * 1000, g.bound_mm * 1000, tolerance * 1000, where));
  if (!(g.clearance_mm >= g.required_clearance_mm))
    reasons.push_back(fmt::format("clearance of shank and holder: {:.4f} mm is below {:.4f} mm; {}", g.clearance_mm,
                                  g.required_clearance_mm, told(g.closest)));
  if (v.ridge.requested_mm > 0 && !(v.ridge.reached_mm <= v.ridge.requested_mm))
    reasons.push_back(fmt::format("ridge: {:.4f} mm is left on the root at cone distance {:.3f} mm, asked {:.4f} mm",
                                  v.ridge.reached_mm, v.ridge.cone_distance_mm, v.ridge.requested_mm));
  if (limits.left_mm && !(v.finished.bound_mm <= *limits.left_mm))
    reasons.push_back(fmt::format("material left on the walls: {:.2f} um measured, {:.2f} um proven, limit {:.2f} um",
                                  v.finished.max_mm * 1000, v.finished.bound_mm * 1000, *limits.left_mm * 1000));
}

void add_moving_axes(MovingAxes& out, const readback::OperationTrace& trace, std::span<const path::ToolMotion> motions,
                     const readback::NcControl& control) {
  std::set<int> along_path;  // lines
  for (const auto& m : motions) {
    const Vec3 d = m.tip_to - m.tip_from, u = (m.axis_from + m.axis_to).normalized();
    if (!m.rapid && (d - d.dot(u) * u).norm() > kAlongAxis * d.norm()) along_path.insert(m.line);
  }
  for (std::size_t i = std::max<std::size_t>(1, trace.before); i + trace.after < trace.moves.size(); ++i) {
    const readback::ExecutedMove &from = trace.moves[i - 1], &to = trace.moves[i];
    if (to.rapid || !to.known || !along_path.contains(to.line)) continue;
    std::size_t n = 0;
    for (std::size_t k = 0; k < 5; ++k)
      if (control.letters[k] && std::abs(to.joints[k] - from.joints[k]) > kRoundedLinear)
        out.letter[k] = control.letters[k], ++n;
    out.simultaneous = std::max(out.simultaneous, n);
  }
}

/// One direction an operation and half: the angle of the axis, and which axes were seen to move.
std::vector<proof::DirectionChoice> directions_of(const bevel_gear::BevelGear& g, const job::Job& job,
                                                  const process::ProgramProof& proof, double tilt_rad,
                                                  const MovingAxes& moving) {
  std::vector<proof::DirectionChoice> directions;
  static constexpr const char* kCount[] = {"no", "one", "two", "three", "four", "five"};
  for (const auto& operation : proof.read.operations) {
    if (operation.operation < 0 || static_cast<std::size_t>(operation.operation) >= job.operations.size()) continue;
    for (std::size_t zone = 0; zone < g.halves().size(); ++zone) {
      proof::DirectionChoice d;
      d.operation = operation.operation;
      d.zone = static_cast<int>(zone);
      d.axis = g.axis(0);
      d.lean_rad = kPi / 2 - g.delta();
      d.clearance_mm = proof.gouge.clearance_mm;
      d.clearance_at_least = proof.gouge.clearance_at_least();
      d.explanation = fmt::format(
          "normal to the pitch cone, {:.4f} deg to the gear axis, to within {:.4f} deg: {} simultaneous axes ({}) plus "
          "fixed tilt",
          degrees(d.lean_rad), degrees(tilt_rad), kCount[std::min<std::size_t>(5, moving.simultaneous)],
          moving.letters());
      directions.push_back(std::move(d));
    }
  }
  return directions;
}

report::Finding ridge_of(const finger::RidgeResult& ridge) {
  report::Finding finding;
  finding.key = "ridge_mm";
  finding.label = "highest ridge";
  finding.value = ridge.reached_mm;
  finding.limit = ridge.requested_mm;
  finding.unit = "mm";
  finding.decimals = 4;
  finding.state = ridge.reached_mm <= ridge.requested_mm ? report::Finding::State::good : report::Finding::State::bad;
  finding.details = {{"requested", ridge.requested_mm},
                     {"reached", ridge.reached_mm},
                     {"cone_distance", ridge.cone_distance_mm},
                     {"azimuth_deg", degrees(ridge.azimuth_rad)}};
  return finding;
}

/// The ridges are the cusps of these passes: the walls are made in one.
report::Finding scallop_of(const finger::RidgeResult& ridge) {
  report::Finding finding;
  finding.key = "scallop_um";
  finding.details = {{"requested", app::um(ridge.requested_mm)},
                     {"reached_min", app::um(ridge.least_mm)},
                     {"reached_max", app::um(ridge.reached_mm)}};
  return finding;
}

/// How the axis stands, and what moves while it does: beside the directions of the tool.
report::Finding tilt_of(const bevel_gear::BevelGear& gear, const MovingAxes& moving) {
  report::Finding finding;
  finding.key = "tilt";
  finding.details = {{"lean_deg", 90 - degrees(gear.delta())},
                     {"simultaneous_axes", moving.simultaneous},
                     {"moving_axes", moving.letters()}};
  return finding;
}

/// The last operation that finishes, by index.
std::optional<std::size_t> finisher(const job::Job& job) {
  for (std::size_t n = job.operations.size(); n-- > 0;)
    if (job.operations[n].type == path::OperationType::finger_finishing) return n;
  return std::nullopt;
}

/// Teeth that are cut otherwise than the first one: how far away, mm.
std::map<int, double> unlike_teeth(const process::ProgramProof& program, const job::Job& job) {
  std::map<int, double> away;
  for (const process::ToothCut& other : program.other_teeth) {
    const auto& tool = job.tools[std::size_t(job.operations[std::size_t(other.operation)].tool)];
    double& most = away[other.tooth];
    most = std::max(most, other.again.away(tool.stick_out_mm));
  }
  return away;
}

}  // namespace

/// The middle of a tooth space winds about the axis from the reference cone distance on.
double azimuth_from_space_0(const bevel_gear::BevelGear& gear, const Vec3& tip) {
  const double ell =
      std::clamp(bevel_gear::cone_point(tip, gear.sin_delta(), gear.cos_delta()).ell, gear.R_i(), gear.R_e());
  const bevel_gear::BevelHalf& half = ell > gear.R_ref() ? gear.halves().back() : gear.halves().front();
  const auto& trace = half.walls[0].trace;
  return std::atan2(tip.y(), tip.x()) - trace.middle(trace.beta(ell)).e;
}

std::string MovingAxes::letters() const {
  std::string out;
  for (const char c : letter)
    if (c != 0) out += c;
  return out;
}

BevelGearCheck::BevelGearCheck(const job::Job& job, const machines::Machine& machine, const proof::ProofLimits& limits,
                               const bevel_gear::BevelGear& gear, const finger::FingerGougeCheck& check)
    : job_(job), machine_(machine), limits_(limits), gear_(gear), check_(check) {}

int BevelGearCheck::teeth() const { return gear_.parameters().teeth; }

double BevelGearCheck::motion_tolerance() const { return kFingerMotionTolerance; }

double BevelGearCheck::pitches_from_space_0(const Vec3& tip) const {
  return azimuth_from_space_0(gear_, tip) / gear_.pitch();
}

/// Against the cone of the blank, hub and shaft: engaging rapids pass beside the cone, inside the cylinder that links
/// avoid.
Status BevelGearCheck::rapids_clear(const readback::OperationTrace& trace, const readback::NcControl& control) const {
  auto motions = readback::tool_motions(trace, {}, control, machine_, *job_.setup, teeth(),
                                        {kFingerMotionTolerance, kFingerMotionTolerance});
  if (!motions) return motions.error();
  int operation = trace.operation;  // below 0: ahead of the first one, where only the tool is known
  int tool = trace.tool;
  for (const tool::ToolAssembly& sister : job_.tools)
    if (sister.number == trace.tool && sister.sister_of != 0) tool = sister.sister_of;
  for (std::size_t k = 0; k < job_.operations.size() && operation < 0; ++k)
    if (job_.tools[static_cast<std::size_t>(job_.operations[k].tool)].number == tool) operation = static_cast<int>(k);
  for (path::ToolMotion& m : *motions) m.operation = operation;
  if (operation < 0 && !motions->empty())
    return fail_as(DiagnosticKind::verification, "line {}: no operation has tool {}", motions->front().line,
                   trace.tool);
  const proof::GougeResult met = check_.rapids(*motions);
  if (met.rapids_clear) return Ok{};
  const auto first =
      std::min_element(met.worst.begin(), met.worst.end(),
                       [](const proof::WorstPlace& a, const proof::WorstPlace& b) { return a.line < b.line; });
  return fail_as(DiagnosticKind::verification, "a rapid passes through the blank; {}", told(*first));
}

bool BevelGearCheck::may_cut(const path::ToolMotion& motion) const { return check_.among_teeth(motion); }

bool BevelGearCheck::measures(int operation) const { return finisher(job_) == std::size_t(operation); }

/// No job asks for the stock that the walls keep: a plan tells it.
process::LoadJudge BevelGearCheck::load_judge() const {
  process::LoadQuery query{.job = job_,
                           .in_blank = [this](const Vec3& p) { return bevel_gear::in_blank(gear_, p); },
                           .top_mm = INFINITY,
                           .chart = {-gear_.sin_delta(), gear_.cos_delta()}};
  for (const path::MillingOperation& op : job_.operations) {
    const tool::ToolAssembly& tool = job_.tools[std::size_t(op.tool)];
    const auto own = finger::gear_for_finger_mill(gear_, tool);
    query.mills.push_back(finger::finger_profile((own ? *own : gear_).cutter(), tool, kLoadSag));
    query.bodies.push_back(tool::proof_tool(query.mills.back(), tool.number, kLoadSag));
    query.stock_before_mm.push_back(INFINITY);
  }
  query.plan = plan_anew;
  return process::LoadJudge(std::move(query));
}

/// Before copies go: the joints of turned teeth differ where the gear is off the axis of its rotary.
void BevelGearCheck::meet(const readback::OperationTrace& trace, std::span<const path::ToolMotion> motions,
                          const readback::NcControl& control) {
  add_moving_axes(moving_, trace, motions, control);
}

void BevelGearCheck::judge(process::ProgramProof& program, app::StageClock& clock) {
  const MovingAxes moving = std::exchange(moving_, {});
  const std::map<int, double> unlike = unlike_teeth(program, job_);
  process::LoadedOtherwise loaded(program, *this);
  clock.run("proof of the program", [&] {
    process::with_all_motions(program, [&](const auto& motions, auto likes) {
      loaded.see(motions, likes);
      result = finger::verify_teeth(check_, motions, likes, unlike);
    });
  });
  const std::size_t before = program.reasons.size();
  judge_teeth(limits_, result, program.reasons);
  if (program.reasons.size() > before)
    for (const process::ToothCut& other : program.other_teeth)
      if (other.again.missing && !other.cuts_nothing() && measures(other.operation))
        program.reasons.push_back(told(other));
  if (program.others_text)
    clock.run("engagement", [&] {
      const std::vector<path::ToolMotion> firsts = process::first_in_space_0(program.motions, teeth());
      const process::LoadJudge load = load_judge();
      load.judge(firsts, program.reasons);
      load.judge_by_plan(firsts, program.reasons, program.warnings);
      loaded.judge(program, load);
    });
  program.gouge = result.gouge;
  program.excess = result.operations;
  if (finisher(job_)) program.finished = result.finished;
  program.surface = std::move(result.walls);
  program.directions = directions_of(gear_, job_, program, result.tilt_rad, moving);
  if (result.ridge.points > 0) {
    program.findings.push_back(ridge_of(result.ridge));
    program.findings.push_back(scallop_of(result.ridge));
  }
  if (!program.directions.empty()) program.findings.push_back(tilt_of(gear_, moving));
}

}  // namespace toothpath::bevel
