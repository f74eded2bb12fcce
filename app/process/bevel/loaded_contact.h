// A pair of bevel gears under load: both walls over a pitch.
#pragma once

#include "app/job/job.h"
#include "app/process/gear_of_job.h"
#include "app/process/under_load/loaded_contact.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/contact/bevel_contact.h"

namespace toothpath::bevel {

/// Refused, where the key stands: a rim that does not fit the wheel, a pinion that floats without two halves, teeth
/// that have no bricks, a position where nothing touches or that does not settle.
/// @param settings  with a load
/// @param left   what stands on the walls as cut or measured, loaded beside the drawn ones; empty: nothing is
/// @param route  "milled", "measured": how it came about
[[nodiscard]] process::ValueOrErrors<under_load::LoadedContact> analyse_loaded(
    const job::Job& job, const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
    const job::ContactSettings& settings, const contact::BevelLeft& left, const std::string& route);

/// Decks of CalculiX at the first position, one a half and wall, the wheel turned by the mean approach. Refused: as
/// analyse_loaded.
[[nodiscard]] process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job,
                                                                       const bevel_gear::BevelGear& pinion,
                                                                       const bevel_gear::BevelGear& wheel,
                                                                       const under_load::LoadedContact& found,
                                                                       const job::ContactSettings& settings);

}  // namespace toothpath::bevel
