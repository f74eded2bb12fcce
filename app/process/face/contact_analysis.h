// Everything about the contact of one job's face gear with the pinion of its shaper: both flanks, the exact surface
// and, where it is there, the cut one.
#pragma once

#include "app/process/cut_flanks.h"
#include "app/process/face/loaded_contact.h"
#include "app/process/gear_of_job.h"
#include "app/process/rolled/pair.h"

namespace toothpath::face {

struct ContactGrid {
  int rows = 41, columns = 49;  ///< of the exact flank
  int steps = 48;               ///< positions a pitch
};

/// Refused: a pinion that cannot run (place: contact.pinion_teeth or gear.mate_teeth); a flank that is not there; a
/// pinion out of reach.
[[nodiscard]] process::ValueOrErrors<rolled::RolledPair> analyse_contact(const job::Job& job,
                                                                         const face_gear::FaceGear& gear,
                                                                         const job::ContactSettings& settings,
                                                                         const process::CutFlanks* cut,
                                                                         const ContactGrid& grid = {});

}  // namespace toothpath::face
