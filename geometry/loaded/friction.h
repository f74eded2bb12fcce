// What friction could add to a position that was found without it: a bound, not a solution. Every place slides as the
// rigid pair does; its friction is mu f against the sliding. Units N, mm. Derivation: docs/loaded_contact.md.
#pragma once

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

/// Two rigid gears as they turn, whatever their type. Housing frame; turns are right-handed about the axes, mm, rad.
struct Turning {
  Vec3 gear_axis = Vec3::UnitZ(), gear_origin = Vec3::Zero();      ///< unit; a point of the axis
  Vec3 pinion_axis = Vec3::UnitX(), pinion_origin = Vec3::Zero();  ///< away from the gear's axis
  double ratio = 1;     ///< turn of the gear for one of the pinion, with its sign
  double still_mm = 0;  ///< what slides by no more does not: on the pitch line
};

/// Velocity of the pinion's flank against the gear's at a place of the housing, for a turn of the pinion by 1 rad: mm.
/// v = a_1 x (P - O_1) - ratio a_2 x (P - O_2).
[[nodiscard]] Vec3 sliding(const Turning& turning, const Vec3& point);
[[nodiscard]] Vec3 sliding(const LoadedPair& pair, const PairRing& ring, const Vec3& point);

/// Signs are for a pinion that turns forward (about its axis away from the gear's); backward they turn over.
struct Friction {
  double axial_n = 0;        ///< on the pinion, along its axis, all places together
  double axial_bound_n = 0;  ///< sum over the places of mu f |v.a|/|v|
  double torque_part = 0;    ///< of the gear's torque, all places together
  double torque_bound = 0;   ///< sum over the places of mu f |lever of v| / |v|, part of the gear's torque
};
/// @param turning  of a ring; rings of one pinion may stand on axes of their own numbers
/// @param torque_nmm  of the gear, > 0 where anything carries
/// @param mu  coefficient of friction, >= 0
[[nodiscard]] Friction friction_of(const std::function<Turning(int ring)>& turning, const LoadedPosition& position,
                                   double torque_nmm, double mu);
[[nodiscard]] Friction friction_of(const LoadedPair& pair, const LoadedPosition& position, double mu);

}  // namespace toothpath::loaded
