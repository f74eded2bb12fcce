// Run time with the accelerations of the axes.
//
// Model: every block is straight in the joints and asks for the joint speeds v = dq / t, t its time in the program. The
// control runs it at a share s of them, 0 <= s <= 1. Inside a block |ds/dt| <= min_j a_j / |v_j|. From one block to the
// next the share is the same and the speeds jump by s * dv: the control rounds the corner within the shortest block
// time tau, so that s <= min_j a_j tau / |dv_j|. Rapids, and everything that is no feed block, begin and end at rest.
// The greatest s that keep all of this come from one pass forward and one backward; each block then takes its
// trapezoid. Blocks with TCP are taken as straight in the joints, too.
//
// So the time is never below that of the program, falls when an acceleration grows, and goes to that of the program.
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

/// Time of a move from rest to rest [min].
[[nodiscard]] double time_from_rest(double distance, double speed, double acceleration);

/// Fills in `accelerated` of the program and its operations, and the ruler "acceleration": feed blocks that take more
/// than 1 % longer than the program asks are counted there, over all blocks that the program holds. Nothing without
/// accelerations in the machine file.
void estimate_times(AxisProgram& program, const machines::Machine& machine);

}  // namespace toothpath::joints
