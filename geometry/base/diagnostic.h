// A located message: what is wrong, where it was said, its value and its limit.
#pragma once

#include <string>
#include <vector>

namespace toothpath {

/// Place in a text file. Lines and columns count from 1; 0 means "unknown".
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Why a run stops. Decides the exit code, never the text.
enum class DiagnosticKind {
  refused_input,  ///< the job, machine, program or mesh file is wrong (exit 3)
  verification,   ///< the result cannot be proven safe (exit 1)
  file_access,    ///< a file cannot be read or written (exit 4)
  usage,          ///< the command line is wrong (exit 2)
  interrupted,    ///< stopped by a signal (exit 130)
};

struct Diagnostic {
  DiagnosticKind kind = DiagnosticKind::refused_input;
  SourcePosition position;  ///< empty file: the folder that made it knows no file
  std::string message;  ///< quantity, value and limit; no trailing full stop or newline. Quoted bytes stay as they are

  /// `file:line:column: error: message`, one line of printable text; the parts that are unknown are left out.
  [[nodiscard]] std::string text() const;
};

/// All texts, one a line.
[[nodiscard]] std::string to_text(const std::vector<Diagnostic>& diagnostics);

}  // namespace toothpath
