// `toothpath contact JOB --mate OTHER` for gears that stand on tooth spaces, whatever their types.
#pragma once

#include "app/process/toothed_pair/shafts.h"

namespace toothpath::toothed_pair {

/// Refused, each with its place: what is asked and such pairs do not have.
[[nodiscard]] process::ValueOrErrors<Shafts> accepted(const JobGear& job, const JobGear& mate,
                                                      const process::ContactAsked& asked);

/// contact.csv, ease_off.csv, transmission.csv, contact.json and contact.html. @param cut  the flanks of the job as
/// they were cut; may be null. Refused: flanks that never meet.
[[nodiscard]] process::ValueOrErrors<process::ContactFound> roll_pair(const JobGear& job, const JobGear& mate,
                                                                      const Shafts& shafts,
                                                                      const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock);

}  // namespace toothpath::toothed_pair
