// Which of the machine's angle pairs and turns a path takes: no change inside a pass, continuous rotaries, limits,
// least time for the repositions between passes, then least tilt.
#pragma once

#include <array>
#include <vector>

#include "cam/path/cl_path.h"
#include "geometry/base/result.h"
#include "machines/machine.h"

namespace toothpath::choice {

using RotaryPair = std::array<double, 2>;

/// Interval that the commands of a rotary must stay in [rad].
struct RotaryRange {
  double lower = 0, upper = 0;
};

/// Rotary commands of every record, in its order [rad].
///
/// A pass is what lies between two rapids. Inside it pair and turn stay; between passes they may change, dynamic
/// programming over the passes finds the quickest sequence (ties: less tilt, then less turn, then pair 1). Where the
/// tool is parallel to the first rotary for the whole pass, that rotary stands at its zero, or as near to it as its
/// range allows; where it is so at some records only, it keeps the angle of its neighbour. A rotary that rolls over has
/// no turns to choose: each pass begins within half a turn of the end of the one before.
/// @param table_from_gear directions of the gear frame in the table frame
/// @param ranges of the two rotaries, margins taken off
/// @param only_pair 1 or 2: that pair alone; 0: either
/// @param switches not empty: one a record; where it is set, on a pole, the pass goes on with the other pair of angles
/// Errors: no angle reaches an axis; no candidate inside the ranges; a block inside a pass in which a rotary would turn
/// by 170 deg or, near the pole, by more than 30 deg (handle_poles leaves no such block).
[[nodiscard]] Result<std::vector<RotaryPair>> choose_rotaries(const path::ClPath& path, const Mat3& table_from_gear,
                                                              const machines::KinematicChain& chain,
                                                              const std::array<RotaryRange, 2>& ranges,
                                                              machines::PoleOption pole,
                                                              const std::vector<char>& switches = {},
                                                              int only_pair = 0);

/// Whole turns [rad] that take an angle next to `reference`.
[[nodiscard]] double whole_turns(double angle, double reference);
/// angle + whole turns, nearest to `reference`.
[[nodiscard]] double nearest_turn(double angle, double reference);

}  // namespace toothpath::choice
