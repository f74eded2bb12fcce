// The flanks that the strokes of a gear shaper leave.
#pragma once

#include <vector>

#include "app/job/job.h"
#include "app/process/cut_flanks.h"
#include "app/process/gear_of_job.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::face {

/// Places of the exact flanks, both sides of every zone, where nothing has been measured yet.
[[nodiscard]] process::ValueOrErrors<std::vector<process::CutFlanks::Flank>> places_on(const job::Job& job,
                                                                                       const face_gear::FaceGear& gear,
                                                                                       int rows, int columns);

/// The strokes of a job's gear shaper at given places: one turn of the work at full depth. Refused: what `shaper`
/// refuses.
[[nodiscard]] process::ValueOrErrors<process::CutFlanks> shaped_flanks(const job::Job& job,
                                                                       const face_gear::FaceGear& gear,
                                                                       std::vector<process::CutFlanks::Flank> places);

}  // namespace toothpath::face
