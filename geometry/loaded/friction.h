// What friction could add to a position that was found without it: a bound, not a solution. Every place slides as the
// rigid pair does; its friction is mu f against the sliding. Units N, mm. Derivation: docs/loaded_contact.md.
#pragma once

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

/// Velocity of the pinion's flank against the gear's at a place of the housing, for a turn of the pinion by 1 rad: mm.
[[nodiscard]] Vec3 sliding(const LoadedPair& pair, const PairRing& ring, const Vec3& point);

/// Signs are for a pinion that turns forward (about its axis away from the gear's); backward they turn over.
struct Friction {
  double axial_n = 0;        ///< on the pinion, along its axis, all places together
  double axial_bound_n = 0;  ///< sum over the places of mu f |v.a|/|v|
  double torque_part = 0;    ///< of the gear's torque, all places together
  double torque_bound = 0;   ///< sum over the places of mu f |lever of v| / |v|, part of the gear's torque
};
/// @param mu  coefficient of friction, >= 0
[[nodiscard]] Friction friction_of(const LoadedPair& pair, const LoadedPosition& position, double mu);

}  // namespace toothpath::loaded
