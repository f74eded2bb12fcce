// The inspection grid as a part program for a coordinate measuring machine: DMIS 5.2 (ISO 22093).
#pragma once

#include <string>
#include <vector>

#include "geometry/face_gear/gear.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {

/// One `FEAT/POINT` a point with nominal place and normal (gear frame, mm), and one `MEAS/POINT` that touches it, with
/// moves in between that stay in the tooth space and above the teeth. The part alignment (gear frame) and the sensor
/// must have been set by the program that calls it: the text says so. Lines have at most 78 characters, continued by
/// `$`; ASCII, LF. Labels: `Z0P_R3C7` zone 0, side +1 (`P`; `M` for -1), row 3, column 7.
[[nodiscard]] std::string inspection_dmis(const face_gear::FaceGear& gear, const std::vector<InspectionPoint>& points,
                                          const std::string& job_name);

}  // namespace toothpath::inspection
