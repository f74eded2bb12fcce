// Run time of a program with the accelerations of the axes: blocks go through timing::PathTimer, which knows how the
// control passes corners.
//
// With TCP the joints at the ends of the blocks count, straight between them; LinuxCNC plans the words themselves (tip
// and rotaries). Everything that is no feed block begins and ends at rest.
//
// Links move the axes of their kind alone. Behind an operation Z goes up for the tool change, and between teeth the
// index turns together with the rotaries of the first link: both as the text does it.
//
// So a feed move never takes less than the program asks, and as much when accelerations grow.
#pragma once

#include <vector>

#include "machines/machine.h"
#include "postproc/joints/program.h"

namespace toothpath::joints {

/// Times of blocks that follow one another [min]: the same number of entries as `blocks`. `start`: where the axes stand
/// before the first; they rest there and at the end. Every axis has an acceleration.
[[nodiscard]] std::vector<double> accelerated_times(const std::vector<AxisBlock>& blocks, const AxisBlock& start,
                                                    const AxisProgram& program, double tool_length_mm,
                                                    const machines::Machine& machine);

/// Fills in `accelerated` of the program and its operations, `run_minutes` of the blocks (in a loop: of all teeth but
/// the first, which comes from elsewhere), and the ruler "acceleration": feed blocks that take more than 1 % longer
/// than the program asks are counted there, over all blocks that the program holds. Nothing without accelerations in
/// the machine file.
void estimate_times(AxisProgram& program, const machines::Machine& machine);

}  // namespace toothpath::joints
