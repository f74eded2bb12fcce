// Which of several ways every tooth of a program takes: least time for the repositions between the teeth.
#pragma once

#include <span>
#include <vector>

#include "machines/kinematic_chain.h"
#include "postproc/choice/solution.h"

namespace toothpath::choice {

/// One way to cut a tooth: commands of the rotaries where it begins and where it ends [rad].
struct ToothWay {
  RotaryPair begin{}, end{};
  double minutes = 0;  ///< of the repositions within
};

/// Time in which the rotaries get from one pose to another at their rapid speeds, min; one that rolls over goes the
/// shorter way.
[[nodiscard]] double reposition_minutes(const machines::KinematicChain& chain, const RotaryPair& from,
                                        const RotaryPair& to);

/// The way of every tooth, by its place in the list, so that the whole of the repositions takes the least time; of
/// equal ones that of lower places. No list may be empty.
/// @param from where the rotaries stand ahead of the first tooth
[[nodiscard]] std::vector<std::size_t> choose_ways(std::span<const std::vector<ToothWay>> teeth, const RotaryPair& from,
                                                   const machines::KinematicChain& chain);

}  // namespace toothpath::choice
