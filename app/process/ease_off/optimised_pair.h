// What `contact --optimise` found for a pair: as keys of a job, as a job, as numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/process/ease_off/refused_amount.h"

namespace toothpath::ease_off {

/// What a modification is needed for, as the models say it: the pair without it alone.
struct Needed {
  OfMember of;
  double error_um = 0;       ///< transmission error at the pitch radius
  double margin_gap_mm = 0;  ///< least gap in the margins
  double wanted_gap_mm = 0;  ///< that the models have to keep there, so that the roll keeps more than the compound
};

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
  double least_error_rad = 0;   ///< the least error of the search, whatever is taken off
  double nearly_equal_rad = 0;  ///< errors up to here are nearly equal to it: of those the least removal was sought
  double removal_mm = 0;        ///< the most that they take at one place of a flank
  std::vector<Needed> needed;   ///< each of them
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
