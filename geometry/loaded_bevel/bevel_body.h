// The tooth of a bevel gear as an elastic body: 20-node bricks on the exact walls and the mill's corner arc, between
// the ends of one half. Blank frame of the gear. mm, N, rad. Derivation: docs/loaded_contact.md 8.
#pragma once

#include "geometry/bevel_gear/gear.h"
#include "geometry/loaded/tooth_body.h"

namespace toothpath::loaded_bevel {

/// The bricks alone, without what they have beyond a half-space: for other solvers. A section stands at a cone
/// distance; in it the tooth lies between space -1 and space 0, from the tip down to the root cone, the rim below at
/// right angles to the pitch cone. Stations count in (cone distance, height over the pitch cone).
/// @param half   0, of a herringbone 1 for the outer one
/// @param sigma  the loaded wall: +1 L, -1 U
/// Refused: a rim that reaches the axis, a place that a wall does not have, bricks that fold.
[[nodiscard]] Result<loaded::ToothBody> bevel_bricks(const bevel_gear::BevelGear& gear, int half, int sigma,
                                                     const elastic::SectorPlan& plan);

/// With them. Refused: as above; a stiffness that is not positive definite.
[[nodiscard]] Result<loaded::ToothBody> bevel_body(const bevel_gear::BevelGear& gear, int half, int sigma,
                                                   const loaded::BodyPlan& plan);

/// The thickest rim that a gear can have: its back keeps a quarter of the root's radius at the small end, mm.
[[nodiscard]] double thickest_rim(const bevel_gear::BevelGear& gear);

}  // namespace toothpath::loaded_bevel
