#include "app/process/bevel/ledger.h"

#include <algorithm>
#include <cmath>

#include "app/base/units.h"
#include "app/process/ledger_sources.h"
#include "cam/finger/reference.h"
#include "cam/proof/limits.h"
#include "geometry/base/tolerances.h"

namespace toothpath::bevel {
namespace {

constexpr double kVerification = proof::ProofLimits{}.proof_mm;  // poses between samples
constexpr double kOnPath = 1e-4;  // mm: a centre this near to a wall's path belongs to it

struct Planned {
  double solve_mm = 0,
         chord_mm = 0;  // greatest distance of a record from the path of a wall, and of the middle of a block
};

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

}  // namespace

std::vector<proof::LedgerEntry> ledger(const bevel_gear::BevelGear& gear, std::span<const finger::FingerPlan> plans,
                                       const joints::AxisProgram& program, const process::ProgramProof& proof,
                                       const finger::FingerCheckResult& found, double blend_mm) {
  double chord = 0, ridge = 0;
  for (const auto& plan : plans) {
    chord = std::max(chord, plan.chord_mm);
    ridge = std::max(ridge, plan.ridge_predicted_mm);
  }
  const Planned planned = measure_planned(gear, plans);
  const double depth = gear.parameters().addendum_mm + gear.parameters().dedendum_mm;
  std::vector<proof::LedgerEntry> out;
  out.push_back(process::entry(proof::ErrorSource::flank_solve, Tolerances{}.flank_mm, planned.solve_mm,
                               "centres of the records against the paths of the walls"));
  out.push_back(
      process::entry(proof::ErrorSource::chord, chord, planned.chord_mm, "middles of the blocks along the walls"));
  out.push_back(process::entry(proof::ErrorSource::ridge, ridge, found.ridge.reached_mm,
                               "stands on the root: no part of the sum on the walls"));
  out.push_back(process::entry(
      proof::ErrorSource::orientation, depth * (program.axis_bound_rad + process::rotary_rounding(program)),
      depth * found.tilt_rad, "lean of the axis against the normal of the pitch cone, over the tooth depth"));
  process::add_machine_sources(out, program, proof.comparison, proof.read, blend_mm);
  const process::Stated& stated = proof.stated;
  double path = 0;
  for (const auto& e : out)
    if (e.source != proof::ErrorSource::ridge) path += e.predicted_um / app::kUm;
  out.push_back(process::entry(proof::ErrorSource::verification,
                               kVerification + path + stated.tip_mm + depth * stated.axis_rad,
                               proof.gouge.bound_mm - proof.gouge.measured_mm,
                               "the bound counts every pose of the cutter, the measurement the points of a grid"));
  return out;
}

}  // namespace toothpath::bevel
