// Rotaries that the control counts within one turn (`rollover` of the machine file). Inside the program their words go
// on beyond a turn like those of any rotary; the writer prints them modulo 360. The control sees the place within the
// turn alone, so that no block may turn such an axis by half a turn or more, and a reposition goes the nearer way.
#pragma once

#include <cstdint>
#include <vector>

#include "postproc/choice/solution.h"
#include "postproc/joints/program.h"
#include "postproc/joints/words.h"

namespace toothpath::joints {

/// Any rotary of the chain rolls over.
[[nodiscard]] bool rolls_over(const machines::KinematicChain& chain);

/// Moves the angles of every rotary that rolls over by the same whole turns, so that the first lies within half a turn
/// of `from` [rad].
void roll_to(const machines::KinematicChain& chain, const RotaryPair& from, std::vector<RotaryPair>& angles);

/// The blocks of a turn that ends in `to`, like it but for the rotary words: as many as it takes that no rotary that
/// rolls over turns by more than 170 deg in one; usually `to` alone. `from` [rad] is taken in the turn nearest to `to`.
[[nodiscard]] std::vector<AxisBlock> blocks_of_turn(const machines::KinematicChain& chain, const AxisWords& words,
                                                    const RotaryPair& from, const AxisBlock& to);

/// Rotary words at which a tooth of a loop is entered: those of its end, a pitch back, in the turn nearest to its first
/// rotary block.
[[nodiscard]] std::array<std::int64_t, 2> loop_entry(const std::vector<AxisBlock>& tooth, const AxisProgram& program);

/// Word of the same place within one turn, 0 <= word < 360 deg. `turn` = 360 deg as a word.
[[nodiscard]] std::int64_t within_turn(std::int64_t word, std::int64_t turn);

}  // namespace toothpath::joints
