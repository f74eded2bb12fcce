// limits.json of a face gear: where its flanks end.
#pragma once

#include <string>

#include "geometry/face_gear/gear.h"

namespace toothpath::limits {

/// `{"zones": [{"zone", "flanks": [{"side", "undercut_radius", "involute_start_radius", "pointing_radius"}]}]}`; radii
/// in mm, null where a limit does not exist. Beside the keys of the contract: heights, the fillet line at nine radii,
/// and which limit of which side governs. Ends in a line feed.
[[nodiscard]] std::string limits_json(const face_gear::FaceGear& gear);

}  // namespace toothpath::limits
