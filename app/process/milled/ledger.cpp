#include "app/process/milled/ledger.h"

#include <algorithm>
#include <cmath>

#include "app/process/ledger_sources.h"
#include "geometry/base/tolerances.h"

namespace toothpath::milled {
namespace {

constexpr double kPivotShare = 1.8;  // of a pivot error, in tooth thickness: docs/line_milling.md
constexpr double kTouch = 1e-6;      // mm: a record whose ball is this near to a patch touches it
constexpr double kNodesSee = 1.005;  // of a misfit: planned poses are looked at in few heights

struct Planned {
  double solve_mm = 0,
         chord_mm = 0;  // greatest residual of a touching record, greatest sag of a block between two of them
};

/// Records and blocks of a finishing path against the patches themselves.
Planned measure_planned(const analytic::GearDistance& part, const path::ClPath& path, double radius) {
  Planned out;
  analytic::NearestPlace before;
  for (std::size_t k = 0; k < path.records.size(); ++k) {
    const auto& b = path.records[k];
    const Vec3 c = b.tip + radius * b.axis;
    const auto here = part.nearest(c, radius + 0.05);
    const auto touches = [&](const analytic::NearestPlace& q) {
      return q.exact && std::abs(q.distance - radius) < kTouch;
    };
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

/// Height above its two valleys of a cusp that was planned `height` high, where each pass lies up to `moved` beside its
/// place. Sideways errors show with the lean of the crest. Along the normal, two arcs of one curvature that stand d <=
/// 2 moved apart meet d^2 / (16 height) above where they would have; an arc that the other one swallows (d > 4 height)
/// makes no cusp, so that a lower one never exceeds `moved`.
double cusp_of_moved_passes(double height, double moved, double lean) {
  if (height <= 0) return 0;
  return std::max(height + lean * moved + moved * moved / (4 * height), moved);
}

/// What the finishing operations have in common, each row's worst.
struct Finished {
  double solve_mm = 0, chord_planned_mm = 0, chord_mm = 0;
  double lever_mm = 0;    ///< from the tip to the farthest place that cuts
  double moved_mm = 0;    ///< sideways, of passes of a ball
  double scallop_mm = 0;  ///< predicted
  double misfit_planned_mm = 0, misfit_mm = 0;
  bool balls = false;
  std::optional<std::size_t> side;  ///< the operation whose side finishes the flanks
};

/// How high above the tip the side touches.
double contact_top(const line::LinePlan& plan, const tool::ToolAssembly& tool) {
  double top = 0;
  for (const auto& pass : plan.passes) top = std::max(top, pass.contact_top_mm);
  return tool.radius_mm() + top;
}

void add_side(const MilledGear& milled, std::size_t n, double bias_mm, Finished& out) {
  const line::LinePlan& plan = *milled.plan.lines[n];
  const tool::ToolAssembly& tool = milled.tools[std::size_t(milled.plan.paths[n].tool)];
  out.side = n;
  out.lever_mm = std::max(out.lever_mm, contact_top(plan, tool));
  out.misfit_planned_mm =
      line::kPlacesSee * (kNodesSee * plan.misfit_mm + bias_mm + milled.plan.operations[n].chord_mm);
  for (const line::LinePass& pass : plan.passes)
    out.misfit_planned_mm = std::max(out.misfit_planned_mm, line::kPlacesSee * pass.unpassed_mm);
  out.misfit_mm = plan.left_mm();
  out.chord_planned_mm = std::max(out.chord_planned_mm, milled.operations[n].chord_tolerance_mm);
  out.chord_mm = std::max(out.chord_mm, milled.plan.operations[n].chord_mm);
}

void add_ball(const MilledGear& milled, std::size_t n, const joints::AxisProgram& program, Finished& out) {
  const ball::OperationPlan& plan = milled.plan.operations[n];
  const path::ClPath& path = milled.plan.paths[n];
  const path::MillingOperation& op = milled.operations[n];
  const double radius = milled.tools[std::size_t(path.tool)].radius_mm();
  const Planned planned = measure_planned(milled.part, path, radius);
  out.balls = true;
  out.solve_mm = std::max(out.solve_mm, planned.solve_mm);
  out.chord_planned_mm = std::max(out.chord_planned_mm, plan.chord_mm);
  out.chord_mm = std::max(out.chord_mm, planned.chord_mm);
  out.lever_mm = std::max(out.lever_mm, radius);
  // Chords, turning axes and rounded words move the passes, too.
  const double moved =
      plan.chord_mm + program.chord_bound_mm + program.rounding_bound_mm + radius * process::rotary_rounding(program);
  out.scallop_mm = std::max(out.scallop_mm,
                            cusp_of_moved_passes(std::max(plan.scallop_max_mm, op.scallop_mm), moved, plan.crest_lean));
}

/// Of the operations that finish a region, or of the last one where none does.
Finished finished_by(const MilledGear& milled, const joints::AxisProgram& program, double bias_mm) {
  Finished out;
  std::vector<std::size_t> finishers;
  for (const path::Region region : path::kRegions)
    if (const auto n = path::finisher_of(milled.operations, region)) finishers.push_back(*n);
  if (finishers.empty() || !milled.operations.back().finishes()) finishers = {milled.plan.paths.size() - 1};
  std::sort(finishers.begin(), finishers.end());
  finishers.erase(std::unique(finishers.begin(), finishers.end()), finishers.end());
  for (const std::size_t n : finishers)
    if (milled.plan.lines[n]) add_side(milled, n, bias_mm, out);
    else add_ball(milled, n, program, out);
  return out;
}

/// What no program shows: as the job states it.
void add_stated(const MilledGear& milled, const Finished& f, const joints::Setup& setup,
                std::vector<proof::LedgerEntry>& out) {
  if (!f.side) return;
  const tool::ToolAssembly& tool = milled.tools[std::size_t(milled.plan.paths[*f.side].tool)];
  const auto key = [&](const char* name) { return fmt::format("tool {} lacks {}", tool.number, name); };
  const auto times = [](const std::optional<double>& stated, double factor) {
    return stated ? std::optional(*stated * factor) : std::nullopt;
  };
  out.push_back(process::stated_entry(proof::ErrorSource::tool_form, tool.form_error_mm,
                                      "of the radius law, one to one on the flank", key("form_error")));
  out.push_back(process::stated_entry(proof::ErrorSource::half_angle, times(tool.half_angle_error_rad, f.lever_mm),
                                      fmt::format("over {:.2f} mm of contact", f.lever_mm), key("half_angle_error")));
  out.push_back(process::stated_entry(proof::ErrorSource::run_out, times(tool.run_out_mm, 0.5),
                                      "half the total reading", key("run_out")));
  out.push_back(process::stated_entry(proof::ErrorSource::pivots, times(setup.pivot_error_mm, kPivotShare),
                                      "of tooth thickness; the form of a flank changes by a tenth of it",
                                      "[setup] lacks pivot_error"));
}

}  // namespace

std::vector<proof::LedgerEntry> ledger(const MilledGear& milled, const joints::AxisProgram& program,
                                       const process::ProgramProof& proof, const LedgerTerms& terms) {
  const cut::CutSurface& surface = milled.surface;
  if (milled.plan.paths.empty()) return {};
  const Finished f = finished_by(milled, program, terms.bias_mm);
  const auto& scallop = surface.scallop;
  const process::Stated& stated = proof.stated;
  std::vector<proof::LedgerEntry> out;
  out.push_back(process::entry(proof::ErrorSource::flank_solve, Tolerances{}.flank_mm,
                               std::max(f.solve_mm, surface.solve_residual_mm),
                               "feet of the touching records and of the measured grid"));
  out.push_back(process::entry(proof::ErrorSource::chord, f.chord_planned_mm, f.chord_mm,
                               "middles of the blocks between touching records"));
  if (f.side)
    out.push_back(process::entry(proof::ErrorSource::line_misfit, f.misfit_planned_mm, f.misfit_mm,
                                 "what stands along the normals, at records, between them and at borders; smoothing, "
                                 "bias and chord in it"));
  const bool asked = scallop.requested_mm > 0;
  if (f.balls)
    out.push_back(process::entry(proof::ErrorSource::scallop, f.scallop_mm,
                                 asked ? std::max(scallop.reached_max_mm, scallop.fillet_max_mm) : 0,
                                 asked ? "cusps of the cut surface, fillets and root among them"
                                       : "the last operation asks for no cusp height"));
  // The tip is what the words give; what cuts stands up to a lever along the axis.
  out.push_back(process::entry(proof::ErrorSource::orientation,
                               f.lever_mm * (program.axis_bound_rad + process::rotary_rounding(program)),
                               proof.comparison ? f.lever_mm * proof.comparison->worst_axis_rad : 0,
                               "axis of the records against the axis that was read back"));
  process::add_machine_sources(out, program, proof.comparison, proof.read, terms.blend_mm);
  add_stated(milled, f, terms.setup, out);
  out.push_back(
      process::entry(proof::ErrorSource::verification, terms.proof_mm + stated.tip_mm + f.lever_mm * stated.axis_rad,
                     proof.gouge.bound_mm - proof.gouge.measured_mm, "the proven bound above the deepest place found"));
  return out;
}

}  // namespace toothpath::milled
