// What `contact --optimise` found for a pair: as keys of a job, as a job, as numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/process/ease_off/searched_pair.h"

namespace toothpath::ease_off {

struct Optimised {
  bool found = false;
  std::string modify;
  FoundModifications found_on;  ///< beside those that the job has
  KeyTable gear, pinion;        ///< where they stand as keys
  std::string keys;             ///< the same as TOML
  std::string finding;          ///< in words: what it comes to, or what stands in the way
  MisalignmentTable table;      ///< of the pair with them: single misalignments and corners
  double error_rad = 0;         ///< greatest of the table
  double model_error_rad = 0;   ///< what the search thought it would be
  long judged = 0;              ///< candidates
  int rounds = 0;               ///< of search and proof
};

/// As keys, a table each.
[[nodiscard]] std::string keys_text(const Optimised& found);

/// The job's text with the keys behind it, for a file of this name. Refused: a job that cannot take them there.
[[nodiscard]] Result<std::string> job_with_keys(const job::Job& job, const Optimised& found, const std::string& file);

[[nodiscard]] nlohmann::ordered_json optimised_json(const Optimised& found);
/// For the screen.
[[nodiscard]] std::string optimised_summary(const Optimised& found);

}  // namespace toothpath::ease_off
