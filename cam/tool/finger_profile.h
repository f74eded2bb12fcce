// A finger mill as a profile: flat, corner arc, straight, and its involute in hollow arcs.
#pragma once

#include "cam/tool/profile.h"
#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::tool {

/// The cutting part with heights above the tip. The involute becomes arcs through its own points that leave it by at most `sag_mm`; flat,
/// corner arc and straight are exact; above the profile the cylinder goes on to `flute_end_mm`, where the teeth end.
[[nodiscard]] Meridian finger_meridian(const bevel_gear::FingerProfile<double>& cutter, double flute_end_mm, double sag_mm);

}  // namespace toothpath::tool
