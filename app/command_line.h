// The command line: with command_tree the only wrapper of the option parser, and the only place that prints.
#pragma once

namespace toothpath {

/// Runs the program; returns the exit code of the contract. Nothing is thrown.
int run_command_line(int argc, char** argv);

}  // namespace toothpath
