// Memory that is not there ends the process in one way, wherever it happens: one message, one exit code, nothing half
// written. A stream or a library would swallow the exception and report something else.
#pragma once

#include <string>

namespace toothpath::app {

/// What is said, without "error: ".
inline constexpr const char* kOutOfMemory =
    "out of memory: nothing was written; a limit of this shell (ulimit -v), or a job that asks for less (larger "
    "scallop and chord_tolerance, fewer teeth written out)";

/// From now on an allocation that fails removes the registered temporary files and ends the process with
/// ExitCode::internal and kOutOfMemory; while signals are blocked it throws std::bad_alloc as usual, so that renaming
/// is not cut in two. An exception that nobody catches ends it likewise.
void handle_out_of_memory();

/// What goes to stdout then: the JSON object of a command; empty (as at first): nothing.
void set_out_of_memory_answer(std::string text);

}  // namespace toothpath::app
