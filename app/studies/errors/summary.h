// What `study machine-errors` says of its samples.
#pragma once

#include <string>

#include "app/process/opening_and_end.h"
#include "app/studies/samples/sample_file.h"

namespace toothpath::errors {

struct Summary {
  process::NamedFiles files;  ///< machine_errors.csv, .json, .html
  std::string json;           ///< of machine_errors.json
  std::string text;           ///< for the screen
};
inline const std::vector<std::string> kSummaryFiles = {"machine_errors.csv", "machine_errors.json",
                                                       "machine_errors.html"};

/// Errors: a head or a sample that lacks what this study writes, with file and line.
[[nodiscard]] Result<Summary> summary_of(const samples::Merged& samples);

}  // namespace toothpath::errors
