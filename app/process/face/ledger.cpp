#include "app/process/face/ledger.h"

#include <algorithm>
#include <cmath>

#include "app/process/ledger_sources.h"
#include "geometry/base/tolerances.h"

namespace toothpath::face {
namespace {

constexpr double kTouch = 1e-6;  // mm: a record whose ball is this near to a patch touches it

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

}  // namespace

std::vector<proof::LedgerEntry> ledger(const MilledGear& milled, const joints::AxisProgram& program,
                                       const process::ProgramProof& proof, double blend_mm, double proof_mm) {
  const ball::FaceGearPlan& plan = milled.plan;
  const cut::CutSurface& surface = milled.surface;
  if (plan.paths.empty()) return {};
  const path::ClPath& path = plan.paths.back();
  const double radius = milled.tools[std::size_t(path.tool)].radius_mm();
  const Planned planned = measure_planned(milled.part, path, radius);
  const auto& scallop = surface.scallop;
  const process::Stated stated = process::stated_deviation(proof.motions);
  std::vector<proof::LedgerEntry> out;
  out.push_back(process::entry(proof::ErrorSource::flank_solve, Tolerances{}.flank_mm,
                               std::max(planned.solve_mm, surface.solve_residual_mm),
                               "feet of the touching records and of the measured grid"));
  out.push_back(process::entry(proof::ErrorSource::chord, plan.operations.back().chord_mm, planned.chord_mm,
                               "middles of the blocks between touching records"));
  // Chords, turning axes and rounded words move the passes, too.
  const ball::OperationPlan& last = plan.operations.back();
  const double moved =
      last.chord_mm + program.chord_bound_mm + program.rounding_bound_mm + radius * process::rotary_rounding(program);
  const bool asked = scallop.requested_mm > 0;
  out.push_back(process::entry(
      proof::ErrorSource::scallop,
      cusp_of_moved_passes(std::max(last.scallop_max_mm, scallop.requested_mm), moved, last.crest_lean),
      asked ? std::max(scallop.reached_max_mm, scallop.fillet_max_mm) : 0,
      asked ? "cusps of the cut surface, fillets and root among them" : "the last operation asks for no cusp height"));
  // The tip is what the words give; the ball's centre stands a radius along the axis.
  out.push_back(process::entry(proof::ErrorSource::orientation,
                               radius * (program.axis_bound_rad + process::rotary_rounding(program)),
                               proof.comparison ? radius * proof.comparison->worst_axis_rad : 0,
                               "axis of the records against the axis that was read back"));
  process::add_machine_sources(out, program, proof.comparison, proof.read, blend_mm);
  out.push_back(process::entry(proof::ErrorSource::verification, proof_mm + stated.tip_mm + radius * stated.axis_rad,
                               proof.gouge.bound_mm - proof.gouge.measured_mm,
                               "the proven bound above the deepest place found"));
  return out;
}

}  // namespace toothpath::face
