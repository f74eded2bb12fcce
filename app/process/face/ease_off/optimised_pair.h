// `contact --optimise`: crownings and reliefs that keep the pattern inside the flank over a box of misalignments with
// the least transmission error, proven by rolling, as keys of a job.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/process/face/ease_off/misalignment_table.h"
#include "app/process/gear_of_job.h"
#include "geometry/contact/modification_search.h"

namespace toothpath::ease_off {

/// What is looked for, and for which pair.
struct OptimiseAsked {
  const job::Job* job = nullptr;
  int pinion_teeth = 0;
  job::ContactSettings settings;  ///< with a box
  std::string modify = "both";    ///< "gear", "pinion" or "both"
  contact::RollOptions roll;
  int rows = 0, columns = 0;  ///< of the flanks that are rolled
  double pitch_radius_mm = 0;
};

struct Optimised {
  bool found = false;
  std::string modify;
  std::vector<modification::Modification> on_gear, on_pinion;  ///< beside those that the job has
  std::string keys;                                            ///< the same as TOML
  std::string finding;         ///< in words: what it comes to, or what stands in the way
  MisalignmentTable table;     ///< of the pair with them: single misalignments and corners
  double error_rad = 0;        ///< greatest of the table
  double model_error_rad = 0;  ///< what the search thought it would be
  long judged = 0;             ///< candidates
  int rounds = 0;              ///< of search and proof
};

/// Refused: a pair that cannot be rolled or searched where it then stands.
[[nodiscard]] process::ValueOrErrors<Optimised> optimise(const OptimiseAsked& asked);

/// The job's text with the keys behind it, for a file of this name. Refused: a job that cannot take them there.
[[nodiscard]] Result<std::string> job_with_keys(const job::Job& job, const Optimised& found, const std::string& file);

[[nodiscard]] nlohmann::ordered_json optimised_json(const Optimised& found);
/// For the screen.
[[nodiscard]] std::string optimised_summary(const Optimised& found);

}  // namespace toothpath::ease_off
