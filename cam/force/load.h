// Force, chip, torque and deflection of an operation. An estimate: the coefficients are known to some +-50 %, and the
// formula takes the whole stock as cut though a mill that bends leaves some of it.
#pragma once

#include <optional>

#include "cam/force/compliance.h"
#include "cam/force/engagement.h"

namespace toothpath::force {

/// What cutting costs: K N/mm^2 of chip section, K_e N/mm of edge. Defaults: steel, chips of micrometres.
struct Material {
  double cutting_N_mm2 = 3000;
  double edge_N_mm = 15;
  double uncertainty = 0.5;  ///< of every force, as a share of it
};

/// How the mill turns and feeds.
struct Cutting {
  int teeth = 2;
  double helix_rad = 0;  ///< of its flutes; 0: straight, the whole edge enters at once
  double speed_rpm = 0, feed_mm_min = 0;
  [[nodiscard]] double feed_per_tooth_mm() const { return feed_mm_min / (speed_rpm * teeth); }
};

struct OperationLoad {
  double feed_per_tooth_mm = 0;
  double chip_mm = 0, mean_chip_mm = 0;  ///< largest and mean thickness
  double engaged_rad = 0;                ///< angle of a tooth in the material
  double edge_mm = 0;                    ///< b, in the cut at any time
  double force_N = 0;                    ///< F_n, normal to the surface
  double torque_Nm = 0, power_W = 0;     ///< means over a turn
  double height_mm = 0;                  ///< above the tip: where the force acts and the deflection is told
  Compliance compliance;                 ///< mm/N there
  double deflection_mm = 0;
  double uncertainty = 0;  ///< of force and deflection
};

/// With the engagement's edge L, arc a, radius R, area A and section S, helix psi, z teeth and feed per tooth f_z:
///
///     b = min(L, a/tan psi) max(1, max(a, L tan psi) z/(2 pi R)),   h_m = f_z S/A,   F_n = b (0.6 K h_m + K_e)
///     power = n z (K f_z S + K_e A),   torque = power/(2 pi n),   deflection = F_n compliance
///
/// Source: docs/force.md (4) to (6); 0.6 is the share of
/// the normal force. Its error is the material's: +-50 %.
/// Refused: no teeth, speed or feed that is not above 0, a helix outside [0, 90) deg; what `compliance` refuses.
[[nodiscard]] Result<OperationLoad> load_of(const tool::Profile& mill, const Cutting& cutting, const Engagement& cut,
                                            const Material& material = {}, const Elasticity& of = {});

/// A mill is slender for an operation where it bends by more than the operation may leave beside what it was asked to.
/// How many times as much; none: it is stiff enough.
[[nodiscard]] std::optional<double> slender(const OperationLoad& load, double may_leave_mm);

}  // namespace toothpath::force
