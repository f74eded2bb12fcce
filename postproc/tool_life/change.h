// Tools whose life is stated give way to sisters between two teeth, never within one.
//
// What counts are the minutes of all G1 of a tooth, with the accelerations of the axes where the machine states them. A
// tool goes on as long as the next tooth of the order still fits into its life; then the next of its sisters does, in
// all operations that follow too. An operation that changes its tool stands in the program once a tool, each with its
// stretch of the order.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "postproc/joints/program.h"

namespace toothpath::tool_life {

/// A tool and what goes on in its place.
struct LastingTool {
  int number = 0;
  double life_min = 0;       ///< of each of them; above 0
  std::vector<int> sisters;  ///< in the order of their use
};

/// Why the tools do not last.
struct Shortage {
  int tool = 0;            ///< T of the job
  bool one_tooth = false;  ///< a single tooth takes longer than a life: sisters do not help
  std::string text;
};

/// Minutes of the G1 of every place that an operation has here.
[[nodiscard]] std::vector<double> minutes_of_places(const joints::AxisOperation& operation,
                                                    const joints::AxisProgram& program);

/// Divides the operations of a whole program and notes its `tool_uses`; the times of operations that were divided are
/// to be estimated again. @returns all shortages, one a tool; then the program is of no use
[[nodiscard]] std::vector<Shortage> change_tools(joints::AxisProgram& program, std::span<const LastingTool> tools);

}  // namespace toothpath::tool_life
