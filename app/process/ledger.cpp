#include "app/process/ledger.h"

#include <algorithm>
#include <cmath>

#include "app/base/units.h"
#include "cam/finger/reference.h"
#include "geometry/base/angle.h"
#include "geometry/base/tolerances.h"

namespace toothpath::process {
namespace {

constexpr double kTouch = 1e-6;     // mm: a record whose ball is this near to a patch touches it
constexpr double kOnPath = 1e-4;    // mm: a centre this near to a wall's path belongs to it

struct Planned {
  double solve_mm = 0, chord_mm = 0;  // greatest residual of a touching record, greatest sag of a block between two of them
};

/// Records and blocks of a finishing path against the patches themselves.
Planned measure_planned(const analytic::GearDistance& part, const path::ClPath& path, double radius) {
  Planned out;
  analytic::NearestPlace before;
  for (std::size_t k = 0; k < path.records.size(); ++k) {
    const auto& b = path.records[k];
    const Vec3 c = b.tip + radius * b.axis;
    const auto here = part.nearest(c, radius + 0.05);
    const auto touches = [&](const analytic::NearestPlace& q) { return q.exact && std::abs(q.distance - radius) < kTouch; };
    if (touches(here)) {
      // The foot is a contact again: the way from the foot along the normal ends at the centre.
      out.solve_mm = std::max(out.solve_mm, std::abs((here.point - here.foot).norm() - here.distance));
      if (k > 0 && b.kind == path::MoveKind::feed && touches(before)) {
        const auto& a = path.records[k - 1];
        const auto middle = part.nearest(0.5 * (a.tip + radius * a.axis + c), radius + 0.05);
        if (middle.exact) out.chord_mm = std::max(out.chord_mm, std::abs(middle.distance - radius));
      }
    }
    before = here;
  }
  return out;
}

/// Records and blocks of the finishing passes of a finger mill against the paths of the walls.
Planned measure_planned(const bevel_gear::BevelGear& gear, std::span<const finger::FingerPlan> plans) {
  Planned out;
  const finger::WallReference walls[2] = {finger::WallReference(gear, -1), finger::WallReference(gear, 1)};
  for (const auto& plan : plans) {
    if (plan.path.operation_type != to_string(path::OperationType::finger_finishing)) continue;
    const auto& records = plan.path.records;
    const auto offset = [&](const finger::WallReference& wall, const Vec3& tip, const Vec3& axis) {
      const auto pose = finger::cone_pose(gear, tip, axis, 0);
      return std::abs(wall.offset(pose.R_c, pose.theta));
    };
    for (std::size_t k = 1; k < records.size(); ++k)
      for (const auto& wall : walls) {
        const auto &a = records[k - 1], &b = records[k];
        if (b.kind != path::MoveKind::feed) continue;
        const double from = offset(wall, a.tip, a.axis), to = offset(wall, b.tip, b.axis);
        if (from > kOnPath || to > kOnPath) continue;
        out.solve_mm = std::max({out.solve_mm, from, to});
        out.chord_mm = std::max(out.chord_mm, offset(wall, 0.5 * (a.tip + b.tip), (a.axis + b.axis).normalized()));
      }
  }
  return out;
}

/// Largest error of the tool axis from rounding the words of both rotaries, rad.
double rotary_rounding(const joints::AxisProgram& program) {
  const double one = radians(0.5 * std::pow(10.0, -program.format.rotary_decimals));
  return (program.letters[3] != 0 ? one : 0) + (program.letters[4] != 0 ? one : 0);
}

/// Largest tolerance of path blending that the text asks for while cutting.
double blend_read_back(const readback::ReadBack& read) {
  double most = 0;
  for (const auto& trace : read.operations)
    for (const auto& move : trace.moves)
      if (!move.rapid) most = std::max({most, double(move.blend_mm), double(move.corner_path_mm)});
  return most;
}

struct Stated {
  double tip_mm = 0, axis_rad = 0;
};
/// Largest deviations that the motions of the program state while cutting.
Stated stated_deviation(std::span<const path::ToolMotion> motions) {
  Stated out;
  for (const auto& m : motions)
    if (!m.rapid) {
      out.tip_mm = std::max(out.tip_mm, m.deviation_mm);
      out.axis_rad = std::max(out.axis_rad, m.axis_deviation);
    }
  return out;
}

/// Height above its two valleys of a cusp that was planned `height` high, where each pass lies up to `moved` beside its place. Sideways errors
/// show with the lean of the crest. Along the normal, two arcs of one curvature that stand d <= 2 moved apart meet d^2 / (16 height) above
/// where they would have; an arc that the other one swallows (d > 4 height) makes no cusp, so that a lower one never exceeds `moved`.
double cusp_of_moved_passes(double height, double moved, double lean) {
  if (height <= 0) return 0;
  return std::max(height + lean * moved + moved * moved / (4 * height), moved);
}

proof::LedgerEntry entry(std::string source, double predicted_mm, double measured_mm, std::string note = {}) {
  return {std::move(source), predicted_mm * app::kUm, measured_mm * app::kUm, std::move(note)};
}

/// What both kinds of gear share: from the machine's joints to the words.
void add_machine_sources(std::vector<proof::LedgerEntry>& ledger, const joints::AxisProgram& program, const std::optional<readback::ClComparison>& met, const readback::ReadBack& read,
                         double blend_mm) {
  const double worst = met ? met->worst_mm : 0, extra = met ? met->worst_extra_mm : 0;
  const bool turns = program.chord_bound_mm > 0;
  ledger.push_back(entry("axis linearisation", program.chord_bound_mm, turns ? std::max(0.0, extra - worst) : 0,
                         turns ? "blocks against the chords of the path, rounding taken off" : "no rotary axis turns while the tool cuts"));
  ledger.push_back(entry("rounding", program.rounding_bound_mm, worst, "records against the motions that were read back"));
  // In single precision, as the moves that are read back carry it.
  ledger.push_back(entry("path blending", double(float(blend_mm)), blend_read_back(read),
                         blend_mm > 0 ? "the tolerance that the text grants the control" : "the text grants the control none"));
}

}  // namespace

std::vector<proof::LedgerEntry> face_gear_ledger(const analytic::GearDistance& part, const ball::FaceGearPlan& plan, std::span<const tool::ToolAssembly> tools,
                                          const joints::AxisProgram& program, const FaceGearProof& proof, double blend_mm, double proof_mm) {
  if (plan.paths.empty()) return {};
  const path::ClPath& path = plan.paths.back();
  const double radius = tools[std::size_t(path.tool)].radius_mm();
  const Planned planned = measure_planned(part, path, radius);
  const auto& scallop = proof.surface.scallop;
  const Stated stated = stated_deviation(proof.motions);
  std::vector<proof::LedgerEntry> ledger;
  ledger.push_back(entry("flank solve", Tolerances{}.flank_mm, std::max(planned.solve_mm, proof.surface.solve_residual_mm),
                         "feet of the touching records and of the measured grid"));
  ledger.push_back(entry("chord", plan.operations.back().chord_mm, planned.chord_mm, "middles of the blocks between touching records"));
  // Chords, turning axes and rounded words move the passes, too.
  const double moved = plan.operations.back().chord_mm + program.chord_bound_mm + program.rounding_bound_mm + radius * rotary_rounding(program);
  ledger.push_back(entry("scallop", cusp_of_moved_passes(std::max(plan.operations.back().scallop_max_mm, scallop.requested_mm), moved, plan.operations.back().crest_lean),
                         scallop.requested_mm > 0 ? std::max(scallop.reached_max_mm, scallop.fillet_max_mm) : 0,
                         scallop.requested_mm > 0 ? "cusps of the cut surface, fillets and root among them" : "the last operation asks for no cusp height"));
  // The tip is what the words give; the ball's centre stands a radius along the axis.
  ledger.push_back(entry("orientation", radius * (program.axis_bound_rad + rotary_rounding(program)),
                         proof.comparison ? radius * proof.comparison->worst_axis_rad : 0, "axis of the records against the axis that was read back"));
  add_machine_sources(ledger, program, proof.comparison, proof.read, blend_mm);
  ledger.push_back(entry("verification", proof_mm + stated.tip_mm + radius * stated.axis_rad, proof.gouge.bound_mm - proof.gouge.measured_mm,
                         "the proven bound above the deepest place found"));
  return ledger;
}

std::vector<proof::LedgerEntry> bevel_ledger(const bevel_gear::BevelGear& gear, std::span<const finger::FingerPlan> plans, const joints::AxisProgram& program, const BevelProof& proof,
                                      double blend_mm) {
  double chord = 0, ridge = 0;
  for (const auto& plan : plans) {
    chord = std::max(chord, plan.chord_mm);
    ridge = std::max(ridge, plan.ridge_predicted_mm);
  }
  const Planned planned = measure_planned(gear, plans);
  const auto& v = proof.result;
  const double depth = gear.parameters().addendum_mm + gear.parameters().dedendum_mm;
  std::vector<proof::LedgerEntry> ledger;
  ledger.push_back(entry("flank solve", Tolerances{}.flank_mm, planned.solve_mm, "centres of the records against the paths of the walls"));
  ledger.push_back(entry("chord", chord, planned.chord_mm, "middles of the blocks along the walls"));
  ledger.push_back(entry("ridge", ridge, v.ridge.reached_mm, "stands on the root: no part of the sum on the walls"));
  ledger.push_back(entry("orientation", depth * (program.axis_bound_rad + rotary_rounding(program)), depth * v.tilt_rad,
                         "lean of the axis against the normal of the pitch cone, over the tooth depth"));
  add_machine_sources(ledger, program, proof.comparison, proof.read, blend_mm);
  const Stated stated = stated_deviation(proof.motions);
  double path = 0;
  for (const auto& e : ledger)
    if (e.source != "ridge") path += e.predicted_um / app::kUm;
  ledger.push_back(entry("verification", Tolerances{}.proof_mm + path + stated.tip_mm + depth * stated.axis_rad, v.gouge.bound_mm - v.gouge.measured_mm,
                         "the bound counts every pose of the cutter, the measurement the points of a grid"));
  return ledger;
}

double predicted_sum_um(std::span<const proof::LedgerEntry> ledger) {
  double sum = 0;
  for (const auto& e : ledger)
    if (e.source != "ridge") sum += e.predicted_um;
  return sum;
}

}  // namespace toothpath::process
