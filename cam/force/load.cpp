#include "cam/force/load.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::force {
namespace {

constexpr double kNormalShare = 0.6;  // of K, normal to the cut

}  // namespace

Result<OperationLoad> load_of(const tool::Profile& mill, const Cutting& cutting, const Engagement& cut,
                              const Material& material, const Elasticity& of) {
  if (cutting.teeth < 1) return fail("teeth = {} is below 1", cutting.teeth);
  if (!(cutting.speed_rpm > 0 && cutting.feed_mm_min > 0))
    return fail("speed = {} 1/min and feed = {} mm/min are not both above 0", cutting.speed_rpm, cutting.feed_mm_min);
  if (!(cutting.helix_rad >= 0 && cutting.helix_rad < kPi / 2))
    return fail("helix = {} deg is outside 0 to 90 deg", degrees(cutting.helix_rad));
  const auto bends = compliance(mill, cut.height_mm, cut.height_mm, of);
  if (!bends) return bends.error();

  const double z = cutting.teeth, f_z = cutting.feed_per_tooth_mm(), lag = std::tan(cutting.helix_rad),
               K = material.cutting_N_mm2, K_e = material.edge_N_mm;
  const double of_one = lag > 0 ? std::min(cut.edge_mm, cut.arc_mm / lag) : cut.edge_mm;
  const double teeth_in = std::max(cut.arc_mm, cut.edge_mm * lag) * z / (2 * kPi * cut.radius_mm);
  OperationLoad load;
  load.feed_per_tooth_mm = f_z;
  load.mean_chip_mm = f_z * cut.section_mm2 / cut.area_mm2;
  load.chip_mm = f_z * cut.steepest;
  load.engaged_rad = cut.angle_rad();
  load.edge_mm = of_one * std::max(1.0, teeth_in);
  load.force_N = load.edge_mm * (kNormalShare * K * load.mean_chip_mm + K_e);
  const double work_Nmm = z * (K * f_z * cut.section_mm2 + K_e * cut.area_mm2);  // of a turn
  load.torque_Nm = work_Nmm / (2 * kPi) / 1000;
  load.power_W = work_Nmm / 1000 * cutting.speed_rpm / 60;
  load.height_mm = cut.height_mm;
  load.compliance = *bends;
  load.deflection_mm = load.force_N * bends->total();
  load.uncertainty = material.uncertainty;
  return load;
}

std::optional<double> slender(const OperationLoad& load, double may_leave_mm) {
  if (!(load.deflection_mm > may_leave_mm)) return std::nullopt;
  return load.deflection_mm / may_leave_mm;
}

}  // namespace toothpath::force
