// A job's gear on the job's gear shaper. Refusals carry the place of the key that caused them.
#pragma once

#include "app/job/job.h"
#include "app/process/gear_of_job.h"
#include "geometry/face_gear/gear.h"
#include "machines/shaper_machine.h"
#include "postproc/shaper/setup.h"

namespace toothpath::face {

/// The gear shaper of the job. Refused: no [machine], a file that is missing or wrong, a milling machine, assumed
/// values that the job does not accept.
[[nodiscard]] process::ValueOrErrors<machines::ShaperMachine> load_shaper_machine(const job::Job& job);
/// The set-up on that machine. Refused: no [shaping]; what set-up or machine do not allow.
[[nodiscard]] process::ValueOrErrors<shaper::ShaperSetup> plan_shaper(const job::Job& job,
                                                                      const face_gear::FaceGear& gear,
                                                                      const machines::ShaperMachine& machine);
/// Both, as `toothpath shaper` plans it.
[[nodiscard]] process::ValueOrErrors<shaper::ShaperSetup> shaper_setup_of(const job::Job& job,
                                                                          const face_gear::FaceGear& gear);

}  // namespace toothpath::face
