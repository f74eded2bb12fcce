// A finger mill as a profile: flat, corner arc, straight, involute, cylinder. Its form follows from the gear that it
// cuts.
#pragma once

#include "cam/tool/profile.h"
#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::finger {

/// The cutting part with heights above the tip. The flank becomes arcs through its own points that leave it by at
/// most `sag_mm`; flat, corner arc and straight are exact; above the profile the cylinder goes on to `flute_end_mm`,
/// where the teeth end.
[[nodiscard]] tool::Meridian finger_meridian(const bevel_gear::FingerProfile<double>& cutter, double flute_end_mm,
                                             double sag_mm);

/// Height above the tip at which the cutting part ends and the shank begins [mm]: what the tool says, else the end of
/// the profile.
[[nodiscard]] double finger_flute_end(const bevel_gear::FingerProfile<double>& cutter, const tool::ToolAssembly& tool);

/// The whole tool, enclosed in lines, as meshes and obstacles are asked. Cutting part from the flat upwards: corner arc
/// in 16 tangents, flank in chords that leave it by `sag_mm`, cylinder to the end of the flutes. It stands out of the
/// cutter by no more than the greater of sag_mm and r_t / 800; twice sag_mm / cos(psi) where a modification makes the
/// flank round.
[[nodiscard]] tool::Profile finger_profile(const bevel_gear::FingerProfile<double>& cutter,
                                           const tool::ToolAssembly& tool, double sag_mm);

}  // namespace toothpath::finger
