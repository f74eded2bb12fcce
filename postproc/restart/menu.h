// Places of a program where the work can be taken up again after a stop, with their lines in the text as it was
// written.
//
// An operation is a safe place: from its (OP n type) comment on it retracts in machine coordinates, changes the tool,
// sets every modal code, the spindle and the work offset. A tooth can be taken up where it has a line of its own (teeth
// written out, calls of sub-programs): run the opening of the operation, then go on at that line. In a loop of the
// control the line that names the first tooth is edited instead.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "postproc/joints/program.h"
#include "postproc/readback/reader.h"

namespace toothpath::restart {

/// A line of the text, from 1, and the block number that it carries; -1: the dialect has none.
struct RestartLine {
  int line = 0, number = -1;
};

struct RestartTooth {
  int place = 0, tooth = 0;
  RestartLine at;  ///< its comment (TOOTH k), or its first block where it is called; line 0 in a loop
};

struct RestartOperation {
  int operation = 0;
  std::string type;
  RestartLine at;           ///< the comment (OP n type)
  RestartLine first_tooth;  ///< loops: the line that sets the first tooth; line 0: no loop
  RestartLine opening_end;  ///< last line ahead of the first tooth that is written out or called; line 0: a loop
  int tool = 0;             ///< T with which it cuts; an operation that changes its tool has an entry for each
  int tool_before = 0;      ///< T that must be in the spindle: the opening goes on with it; 0: the opening fetches it
  std::vector<RestartTooth> teeth;  ///< in the order of the program
};

struct RestartMenu {
  RestartLine start_end;  ///< last line of the start of the program, ahead of the first operation
  std::vector<RestartOperation> operations;
};

/// Finds the places. `program` tells how many teeth an operation has and in which order they come; every line comes
/// from the text, which is executed where teeth have lines of their own. Errors: what the reader refuses; an operation
/// whose moves are not its teeth.
[[nodiscard]] Result<RestartMenu> restart_menu(std::string_view text, const std::string& file,
                                               const readback::NcControl& control, const joints::AxisProgram& program);

}  // namespace toothpath::restart
