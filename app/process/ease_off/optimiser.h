// `contact --optimise`: crownings and reliefs that keep the pattern inside the flank over a box of misalignments with
// the least transmission error, sought on models and proven by rolling.
#pragma once

#include "app/base/stage_clock.h"
#include "app/process/ease_off/optimised_pair.h"
#include "app/process/gear_process.h"

namespace toothpath::ease_off {

/// A pair off its place, as far as its job and the command ask for it.
struct Misaligned {
  std::optional<MisalignmentTable> table;  ///< where the settings have a box
  std::optional<Optimised> optimised;      ///< where that was asked for
  std::string job_text;                    ///< the job with what was found; empty: nothing was, or nobody asked
  [[nodiscard]] bool missed() const { return optimised && !optimised->found; }
};
/// @param modify  whose flanks may be modified, for the report
/// Refused: --optimise without a box; a pair that cannot be rolled or searched where it then stands; a job that cannot
/// take the keys.
[[nodiscard]] process::ValueOrErrors<Misaligned> misalign(const SearchedPair& pair, const job::Job& job,
                                                          const job::ContactSettings& settings,
                                                          const process::ContactAsked& asked, const std::string& modify,
                                                          app::StageClock& clock);

/// Joins misalignments and optimised, as far as they are there.
void add_misaligned(nlohmann::ordered_json& json, const Misaligned& misaligned);
/// Its tables, the way of the pattern's centre, and what was found.
void add_to_page(page::StudyPage& page, const Misaligned& misaligned);
/// For the screen.
[[nodiscard]] std::string misaligned_summary(const Misaligned& misaligned);

}  // namespace toothpath::ease_off
