// Memory that is not there ends the process in one way, wherever it happens: one message, one exit code, nothing half
// written. A stream or a library would swallow the exception and report something else.
#pragma once

#include <exception>
#include <string>

namespace toothpath::app {

/// What is said, without "error: ".
inline constexpr const char* kOutOfMemory =
    "out of memory: nothing was written; a limit of this shell (ulimit -v), or a job that asks for less (larger "
    "scallop and chord_tolerance, fewer teeth written out)";

/// The same where it ends behind commit().
inline constexpr const char* kOutOfMemoryAtTheEnd =
    "out of memory when all was written: only the words about it are missing; a limit of this shell (ulimit -v)";

/// From now on an allocation that fails removes the registered temporary files and ends the process with
/// ExitCode::internal and kOutOfMemory; while signals are blocked it throws std::bad_alloc as usual, so that renaming
/// is not cut in two. An exception that nobody catches ends it likewise.
void handle_out_of_memory();

/// Asks for more memory than an exchange of results takes, and gives it back: where it is not there, the process ends
/// now, and not between two renames. To be called before signals are blocked.
void require_memory();

/// From now on kOutOfMemoryAtTheEnd is said.
void note_results_written();

/// What goes to stdout then: the JSON object of a command, before and after note_results_written(); empty (as at
/// first): nothing.
void set_out_of_memory_answers(std::string text, std::string at_the_end);

/// What an exception says, in words for the user: threads that cannot start are a lack of memory or processes, too.
[[nodiscard]] std::string words_of(const std::exception& error);

}  // namespace toothpath::app
