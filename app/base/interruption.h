// SIGINT and SIGTERM: leave at once with 130, leave nothing half-written behind, and say what stands in the output
// directory.
#pragma once

#include <string>
#include <string_view>

namespace toothpath::app {

/// From now on SIGINT, SIGTERM and SIGHUP, but those that the caller ignores (nohup), remove the temporary files
/// registered below, then the registered directories that are empty, and end the process with exit code 130. SIGPIPE
/// and SIGXFSZ are ignored: writing returns an error instead.
void handle_signals();

/// A temporary file or a directory made by this run, removed when a signal ends it: `name` in an open directory, which
/// stays open until it is forgotten. At most 128; more are refused (false), as are names beyond 4095 bytes.
/// @param directory  a handle; AT_FDCWD: `name` is a path
[[nodiscard]] bool register_temporary(int directory, const std::string& name, bool is_directory);
void forget_temporary(int directory, const std::string& name);

/// What stands in the output directory: a signal leaves "interrupted: " and this on stderr, at most 1000 bytes of it;
/// empty (as at first): none.
void set_state(const std::string& text);

/// Ends the process: the registered temporary files and empty directories go; `text` goes to stderr, then the state
/// behind `before_state` where there is one. Allocates nothing.
[[noreturn]] void leave_process(std::string_view text, std::string_view before_state, int exit_code);

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
