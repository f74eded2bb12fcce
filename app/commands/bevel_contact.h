// `toothpath contact` for equal-base-circle bevel gears: the pair as cut, rolled as rigid bodies.
#pragma once

#include "app/commands/contact.h"
#include "app/job/job.h"
#include "app/base/output_dir.h"

namespace toothpath::commands {

/// Rolls the job's gear against its mate: the gear of `request.other_job`, else the one that its rules give. Writes contact.csv,
/// transmission.csv, contact.json, contact.html. `output` is open. Refused: what makes no pair, each with its place.
[[nodiscard]] CommandOutcome run_bevel_contact(const ContactRequest& request, const job::Job& job, app::OutputDir& output);

}  // namespace toothpath::commands
