// From a job to the gear and the machine that it asks for; refusals get the place of the key that caused them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "app/job/job.h"
#include "geometry/bevel_gear/gear.h"
#include "geometry/cylindrical/gear.h"
#include "geometry/face_gear/gear.h"
#include "geometry/flank_grid/gear.h"
#include "geometry/spiral_bevel/gear.h"
#include "geometry/straight_bevel/gear.h"
#include "machines/machine.h"

namespace toothpath::process {

template <typename T>
using ValueOrErrors = Expected<T, std::vector<Diagnostic>>;

/// The face gear of the job. Refused: a bevel gear; everything that FaceGear::make refuses, all of it, each with its
/// place.
[[nodiscard]] ValueOrErrors<face_gear::FaceGear> make_face_gear(const job::Job& job);

/// The bevel gear of the job, as its finishing mill makes it (the tool of the last finger_finishing; without one the
/// first finger mill). Refused: a face gear; everything that BevelGear::make refuses, each with its place.
[[nodiscard]] ValueOrErrors<bevel_gear::BevelGear> make_bevel_gear(const job::Job& job);

/// The cylindrical gear of the job. Refused: a gear of another type; everything that CylindricalGear::make refuses,
/// each with its place.
[[nodiscard]] ValueOrErrors<cylindrical::CylindricalGear> make_cylindrical_gear(const job::Job& job);

/// The straight bevel gear of the job. Refused likewise.
[[nodiscard]] ValueOrErrors<straight_bevel::StraightBevelGear> make_straight_bevel_gear(const job::Job& job);

/// The spiral bevel gear of the job. Refused likewise.
[[nodiscard]] ValueOrErrors<spiral_bevel::SpiralBevelGear> make_spiral_bevel_gear(const job::Job& job);

/// The gear by points of the job. Refused likewise; what a point is refused for, at its line of the file.
[[nodiscard]] ValueOrErrors<flank_grid::FlankGridGear> make_flank_grid_gear(const job::Job& job);

/// What a face gear alone can do is refused to a gear of another type.
[[nodiscard]] Diagnostic needs_face_gear(const job::Job& job);

/// The milling machine of the job. Refused: no [machine], a file that is missing or wrong, a gear shaper, assumed
/// values that the job does not accept, an operation that is faster than the spindle or the cutting feed of the
/// machine, line milling that moves more axes at once than its control interpolates, a work offset or a coolant that it
/// does not have; with a part diameter [mm] also a part that does
/// not lie on it.
[[nodiscard]] ValueOrErrors<machines::Machine> load_machine(const job::Job& job,
                                                            std::optional<double> part_diameter_mm = {});

/// The diagnostic with the place of a key of the job, where it has none yet.
[[nodiscard]] Diagnostic located(const job::Job& job, std::string_view key, Diagnostic diagnostic);

}  // namespace toothpath::process
