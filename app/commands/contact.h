// `toothpath contact`: a gear and its mate rolled as rigid bodies: pattern, transmission error, pairs in contact.
#pragma once

#include "app/commands/command.h"
#include "app/process/gear_process.h"

namespace toothpath::commands {

struct ContactRequest : JobRequest, process::ContactAsked {};

/// Writes contact.csv, transmission.csv, of face gears ease_off.csv, contact.json and contact.html. With `as_cut` the
/// job's route is run as well
/// (`run`, or the strokes of `shaper`) and its surface is rolled beside the exact one. Refused: a mate that cannot run;
/// options out of range, and such as the gear type does not have.
[[nodiscard]] CommandOutcome run_contact(const ContactRequest& request);

}  // namespace toothpath::commands
