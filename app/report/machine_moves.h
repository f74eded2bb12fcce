// What is said of the bodies of a machine against each other, in words.
#pragma once

#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/bodies/moves.h"

namespace toothpath::report {

/// "T1 holder meets table, operation 0, tooth 3: 2.31 mm deep, free along (0.00, 0.00, 1.00)", or how near they come.
[[nodiscard]] std::string meeting_text(const bodies::Meeting& meeting, double required_mm);

/// "X 1.000 Y 2.000 Z 3.000 C 0.000 A 30.000".
[[nodiscard]] std::string joints_text(const machines::Machine& machine, const machines::Joints& joints);

/// One line for screen and page; a machine without bodies says so.
[[nodiscard]] std::string machine_moves_text(const bodies::MovesFound& found);

/// Why a program does not pass, one line a pair of bodies; empty: it does.
[[nodiscard]] std::vector<std::string> reasons_of(const machines::Machine& machine, const bodies::MovesFound& found);

/// What would free the pairs that meet, one line a kind of meeting.
[[nodiscard]] std::vector<std::string> help_for(const bodies::MovesFound& found);

}  // namespace toothpath::report
