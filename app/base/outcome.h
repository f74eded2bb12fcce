// What a command gives back: an exit code, what went wrong, what is printed. Commands print nothing themselves.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/base/exit_code.h"
#include "geometry/base/diagnostic.h"

namespace toothpath::app {

struct CommandOutcome {
  ExitCode exit_code = ExitCode::ok;
  std::vector<Diagnostic> errors;
  std::string summary;      ///< for people, on stdout
  std::string report_json;  ///< the report as one JSON object; empty where there is none
};

/// An outcome from refusals: the exit code is that of the first.
[[nodiscard]] inline CommandOutcome failed(std::vector<Diagnostic> errors) {
  CommandOutcome outcome;
  outcome.exit_code = errors.empty() ? ExitCode::internal : exit_code_of(errors.front().kind);
  outcome.errors = std::move(errors);
  return outcome;
}
[[nodiscard]] inline CommandOutcome failed(Diagnostic error) { return failed(std::vector{std::move(error)}); }

}  // namespace toothpath::app
