// A program of LinuxCNC cut down to some teeth of its operations, so that its run takes minutes.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath::test {

/// The program with these teeth of every operation instead of all, and with another word for corners where asked. What
/// the controller runs is what we read. Teeth stand in a loop, or are written out behind (TOOTH k).
///
/// @param teeth        of every operation, "1,1"; of an operation with 0 the whole loop goes, with the lines behind it
///                     that end the turn of the index: they would turn a work offset that no line has placed
/// @param corners_line "written", or a line like "G61.1" in the place of the program's own
/// Errors: other operations than `teeth` has numbers.
[[nodiscard]] Result<std::string> short_program(const std::string& text, const std::string& teeth,
                                                const std::string& corners_line);

}  // namespace toothpath::test
