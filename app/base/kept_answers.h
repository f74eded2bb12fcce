// Answers on a terminal, kept in a file beside the job until that is written: what was said outlives Ctrl-C, an error
// and a lost connection.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/base/dialog.h"
#include "geometry/base/result.h"

namespace toothpath::app {

class KeptAnswers {
 public:
  /// Of this job: they stand in "JOB.answers" beside it. Nothing is touched yet.
  explicit KeptAnswers(const std::string& job);
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Something stands under that name, whatever it is.
  [[nodiscard]] bool there() const;
  /// Errors: kind file_access, and refused_input with the line of what is no answer.
  [[nodiscard]] Result<std::vector<SaidAnswer>> read() const;
  /// All of them at once; what stood there gives way. None: the file goes.
  [[nodiscard]] Status write(std::span<const SaidAnswer> said) const;

 private:
  std::string path_, folder_, name_;
};

}  // namespace toothpath::app
