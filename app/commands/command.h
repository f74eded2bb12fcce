// What every command gets and what it gives back. Commands print nothing: app/command_line.cpp does.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/exit_code.h"
#include "app/stage_clock.h"

namespace toothpath {

struct CommandRequest {
  std::string job_file;
  std::string out_dir;
  std::string program_file;  ///< of `check`
  bool quiet = false;
  bool color = false;  ///< of the summary
  bool quick = false;  ///< studies: the short form
};

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

}  // namespace toothpath
