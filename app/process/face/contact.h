// `toothpath contact` for a face gear: rolled with its pinion, as made and as cut.
#pragma once

#include <vector>

#include "app/process/face/contact_analysis.h"
#include "app/process/gear_process.h"

namespace toothpath::face {

/// The flanks as files of measurements tell of them: the fit of their deviations, on the grid of the roll.
[[nodiscard]] process::ValueOrErrors<process::CutFlanks> measured_flanks(const face_gear::FaceGear& gear,
                                                                         const job::MeasuredInput& measured);

/// contact.csv, ease_off.csv, transmission.csv, contact.json and contact.html. Refused: a pinion that cannot run.
[[nodiscard]] process::ValueOrErrors<process::ContactFound> roll_pair(const job::Job& job,
                                                                      const face_gear::FaceGear& gear,
                                                                      const process::ContactAsked& asked,
                                                                      const process::CutFlanks* cut,
                                                                      app::StageClock& clock);

/// The section on contact of a run's page; see process::GearProcess::contact_section.
[[nodiscard]] std::string contact_section(const job::Job& job, const face_gear::FaceGear& gear,
                                          const std::vector<proof::SurfaceGrid>& surface,
                                          std::vector<std::string>& warnings);

}  // namespace toothpath::face
