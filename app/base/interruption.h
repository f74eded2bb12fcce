// SIGINT and SIGTERM: leave at once with 130, leave nothing half-written behind, and say what stands in the output
// directory.
#pragma once

#include <string>

namespace toothpath::app {

/// From now on SIGINT, SIGTERM and SIGHUP remove the temporary files registered below, then the registered directories
/// that are empty, and end the process with exit code 130. SIGPIPE and SIGXFSZ are ignored: writing returns an error
/// instead.
void handle_signals();

/// A temporary file or a directory made by this run, removed when a signal ends it. At most 64 of each; more are
/// refused (false), as are paths beyond 4095 bytes.
[[nodiscard]] bool register_temporary(const std::string& path, bool is_directory);
void forget_temporary(const std::string& path);

/// The line that a signal leaves on stderr, at most 1000 bytes of it; empty (as at first): none.
void set_last_line(const std::string& text);

/// Ends the process: the registered temporary files and empty directories go, `text` goes to stderr. Allocates nothing.
[[noreturn]] void leave_process(const char* text, std::size_t size, int exit_code);

/// While one of these lives the signals wait: renaming must not be cut in two.
class SignalsBlocked {
 public:
  SignalsBlocked();
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;
  [[nodiscard]] static bool any();
};

}  // namespace toothpath::app
