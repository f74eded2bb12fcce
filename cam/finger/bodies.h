// The bodies of a finger mill assembly as truncated cones: cutting part with its profile, shank, holder.
#pragma once

#include <vector>

#include "cam/tool/assembly.h"
#include "cam/clearance/clearance.h"
#include "geometry/bevel_gear/finger_cutter.h"

namespace toothpath::finger {

/// Height above the tip at which the cutting part ends and the shank begins [mm]: what the tool says, else the end of the profile.
[[nodiscard]] double finger_flute_end(const bevel_gear::FingerProfile<double>& cutter, const tool::ToolAssembly& tool);

/// A polyline about the meridian of the cutting part, (height above the tip, radius) [mm], from the flat upwards: corner arc in tangents, hollow
/// flank in chords that leave it by `sag_mm`, cylinder to the end of the flutes. Turned about the axis it encloses the cutter, by no more than
/// the greater of sag_mm and r_t / 800.
[[nodiscard]] std::vector<Vec2> finger_meridian(const bevel_gear::FingerProfile<double>& cutter, const tool::ToolAssembly& tool, double sag_mm);

/// Cutting part, shank and holder, from below.
[[nodiscard]] std::vector<clearance::MeshBody> finger_bodies(const bevel_gear::FingerProfile<double>& cutter, const tool::ToolAssembly& tool);

}  // namespace toothpath::finger
