// Where a program checks the length of the tool in its spindle, and what that takes. A check stands between operations,
// between the stretches of teeth that an operation is divided into, and where a tool comes or goes: never in a tooth.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "postproc/joints/program.h"
#include "postproc/text/dialect.h"
#include "postproc/text/lines.h"
#include "postproc/text/stops.h"

namespace toothpath::text {

/// Divides the operations of a whole program between teeth, where tools are checked there. Times of operations that
/// were divided are to be estimated again. @returns some were
bool divide_for_checks(joints::AxisProgram& program, const TextWishes& wishes);

/// Marks where tools are checked and notes `check_minutes`. @param tolerance_mm  T -> of its length
void note_tool_checks(joints::AxisProgram& program, const NcDialect& dialect, const TextWishes& wishes,
                      const std::map<int, double>& tolerance_mm);

/// The names that a line of a check may have in braces.
[[nodiscard]] std::vector<std::string> names_of_check_lines();

/// Values of the lines of one check, put to those of the operation. @param label  two numbers from here on are its own
[[nodiscard]] NcLines::Values check_values(const NcLines::Values& of_operation, const joints::AxisOperation& operation,
                                           const NcDialect& dialect, int label);

/// The comment ahead of the lines of a check: "TOOL CHECK T3 WITHIN 0.02 MM". Readers look for it.
[[nodiscard]] std::string check_comment(const joints::AxisOperation& operation);

}  // namespace toothpath::text
