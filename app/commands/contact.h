// `toothpath contact`: a gear and its pinion rolled as rigid bodies: pattern, transmission error, pairs in contact.
#pragma once

#include "app/commands/command.h"
#include "app/job.h"

namespace toothpath {

/// Settings of [contact] with what the command line says instead.
[[nodiscard]] ContactSettings contact_settings(const Job& job, const CommandRequest& request);

/// Writes contact.csv, transmission.csv, contact.json and contact.html. With `as_cut` the job's route is run as well (`run`, or the strokes of
/// `shaper`) and its surface is rolled beside the exact one. A bevel gear: see commands/bevel_contact.h. Refused: a pinion that cannot run; options out of range.
[[nodiscard]] CommandOutcome run_contact(const CommandRequest& request);

}  // namespace toothpath
