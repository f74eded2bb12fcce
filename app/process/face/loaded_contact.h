// A job's face gear and its pinion under load: both flanks over a pitch.
#pragma once

#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/gear_of_job.h"
#include "app/process/opening_and_end.h"
#include "app/process/under_load/loaded_contact.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::face {

/// @param exact  the flanks of the drawing: what modifications take off them and off the pinion moves and bends the
/// lines
/// @param cut    flanks as they were cut or measured, beside them; their deviation, mean over each piece of a line, is
/// a gap. @param route  "milled", "shaped", "measured": how they came about
/// Refused, where the key stands: a rim that does not fit, a pinion that floats on one ring, a position where nothing
/// touches.
[[nodiscard]] process::ValueOrErrors<under_load::LoadedContact> analyse_loaded(
    const job::Job& job, const face_gear::FaceGear& gear, const job::ContactSettings& settings, int pinion_teeth,
    const std::vector<const contact::ContactMember*>& exact, const std::vector<const contact::ContactFlank*>& cut,
    const std::string& route);

/// Decks of CalculiX at the first position, the gear turned by the mean approach. Refused: as analyse_loaded.
[[nodiscard]] process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job,
                                                                       const face_gear::FaceGear& gear,
                                                                       const under_load::LoadedContact& found);

}  // namespace toothpath::face
