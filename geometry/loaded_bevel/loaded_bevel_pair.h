// Two bevel gears of equal base circles under load: elastic teeth, all pairs and both halves at once, on cells, as
// their flanks are not conjugate and touch in points and on edges. Quasi-static, linear, no friction. Units N, mm, MPa,
// rad. Frame: that of BevelPair. Derivation: docs/loaded_contact.md 8.
#pragma once

#include <vector>

#include "geometry/contact/bevel_contact.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded_bevel {

struct BevelPairOptions {
  loaded::BodyPlan wheel, pinion;
  contact::BevelAssembly moved;
  contact::BevelLeft left{};      ///< on the drawn walls, as they were cut or measured; the bodies are as drawn
  bool torque_on_pinion = false;  ///< the torque of Load is the pinion's, not the wheel's
  double edge_radius_mm = 0;      ///< rounding of the edges of the teeth; 0: not stated
};

struct BevelHalfBodies {
  loaded::ToothBody wheel, pinion;
  loaded::FreeEnds wheel_ends, pinion_ends;  ///< in the fixed frame
};

/// Everything that does not depend on load and position. Keeps references: both gears outlive it.
struct LoadedBevelPair {
  contact::BevelPair pair;
  int sigma = 1;
  BevelPairOptions options;
  double modulus = 0;      ///< E*
  double lever = 0;        ///< R_m sin(delta) cos(alpha_n) cos(beta_m) of the gear that the torque is on
  double wheel_lever = 0;  ///< the same, that turns an approach into the lag of the wheel
  double half_axial = 0;   ///< of a unit normal force on the outer half, at its middle: along the pinion's axis
  std::vector<BevelHalfBodies> halves;
};

/// Wall sigma of the wheel on that of the pinion; modifications are in the walls.
/// Refused: as BevelPair::make; teeth that have no bricks, each with the gear and its half.
[[nodiscard]] Result<LoadedBevelPair> make_loaded_bevel_pair(const bevel_gear::BevelGear& pinion,
                                                             const bevel_gear::BevelGear& wheel, int sigma,
                                                             const BevelPairOptions& options);

/// The same bodies with other material on the drawn walls. Refused: as BevelPair::make.
[[nodiscard]] Result<LoadedBevelPair> with_left(LoadedBevelPair pair, const contact::BevelLeft& left);

/// @param load   its torque is that of the gear that the options name
/// @param phi_1  turn of the pinion at the exact ratio; a pitch is 2 pi/z_1
/// Refused: no pair touches; pressures that do not settle; an approach beyond what is looked at; a pinion that nothing
/// balances along its axis.
[[nodiscard]] Result<loaded::LoadedPosition> loaded_position(const LoadedBevelPair& pair, const loaded::Load& load,
                                                             double phi_1);
/// The positions of one pitch, in parallel; the same bits on any number of threads.
[[nodiscard]] Result<loaded::LoadedCycle> loaded_cycle(const LoadedBevelPair& pair, const loaded::Load& load);

}  // namespace toothpath::loaded_bevel
