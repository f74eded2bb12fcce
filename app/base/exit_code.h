// What the process returns.
#pragma once

#include "geometry/base/diagnostic.h"

namespace toothpath::app {

enum class ExitCode {
  ok = 0,             ///< done and verified
  unverified = 1,     ///< gouge, left material, travel: no NC file is left
  usage = 2,          ///< the command line is wrong
  refused = 3,        ///< the job, machine, program or mesh file is wrong
  file_access = 4,    ///< a file cannot be read or written
  internal = 70,      ///< a broken promise inside the program, or no memory
  interrupted = 130,  ///< stopped by a signal
};

[[nodiscard]] constexpr ExitCode exit_code_of(DiagnosticKind kind) {
  switch (kind) {
    case DiagnosticKind::refused_input: return ExitCode::refused;
    case DiagnosticKind::verification: return ExitCode::unverified;
    case DiagnosticKind::file_access: return ExitCode::file_access;
    case DiagnosticKind::usage: return ExitCode::usage;
    case DiagnosticKind::interrupted: return ExitCode::interrupted;
  }
  return ExitCode::internal;
}

}  // namespace toothpath::app
