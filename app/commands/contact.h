// `toothpath contact`: a gear and its pinion rolled as rigid bodies: pattern, transmission error, pairs in contact.
#pragma once

#include <optional>

#include "app/commands/command.h"
#include "app/job/job.h"

namespace toothpath::commands {

/// What stands here comes instead of the keys of [contact].
struct ContactRequest : JobRequest {
  std::optional<int> pinion_teeth;
  std::optional<double> offset_error_mm, angle_error_deg, axial_error_mm, compound_um;
  std::optional<double> wheel_axial_error_mm;  ///< bevel gears
  std::string other_job;  ///< bevel gears: the mate
  bool as_cut = false;    ///< the surface that the job's operations cut, too
};

/// Settings of [contact] with what the command line says instead.
[[nodiscard]] job::ContactSettings contact_settings(const job::Job& job, const ContactRequest& request);

/// Writes contact.csv, transmission.csv, contact.json and contact.html. With `as_cut` the job's route is run as well (`run`, or the strokes of
/// `shaper`) and its surface is rolled beside the exact one. A bevel gear: see commands/bevel_contact.h. Refused: a pinion that cannot run; options out of range.
[[nodiscard]] CommandOutcome run_contact(const ContactRequest& request);

}  // namespace toothpath::commands
