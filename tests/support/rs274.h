// LinuxCNC's stand-alone interpreter as the second opinion on NC text. tools/get_rs274.sh fetches it; the variable
// TOOTHPATH_RS274 names another copy.
#pragma once

#include <string>
#include <vector>

namespace toothpath::test {

struct Canonical {
  int exit = -1;
  std::string messages;
  std::vector<std::string> lines;  ///< canonical commands, joints in mm and deg as words, 4 decimals
};

/// Runs a program with two tools T1, T2 of length zero and no offsets. A missing interpreter fails the test.
/// @param name of the folder, of this process alone  @param ini text of an INI file; empty: none
/// @param parameters lines of the parameter file, "5230 5": a number and its value; what is not there is 0
Canonical interpret(const std::string& program, const std::string& name, const std::string& ini = "",
                    const std::string& parameters = "");

}  // namespace toothpath::test
