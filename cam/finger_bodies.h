// The bodies of a finger mill assembly as truncated cones: cutting part with its profile, shank, holder.
#pragma once

#include <vector>

#include "cam/cutter.h"
#include "cam/mesh_clearance.h"
#include "geometry/finger_cutter.h"

namespace toothpath {

/// Height above the tip at which the cutting part ends and the shank begins [mm]: what the tool says, else the end of the profile.
[[nodiscard]] double finger_flute_end(const FingerProfile<double>& cutter, const ToolAssembly& tool);

/// A polyline about the meridian of the cutting part, (height above the tip, radius) [mm], from the flat upwards: corner arc in tangents, hollow
/// flank in chords that leave it by `sag_mm`, cylinder to the end of the flutes. Turned about the axis it encloses the cutter, by no more than
/// the greater of sag_mm and r_t / 800.
[[nodiscard]] std::vector<Vec2> finger_meridian(const FingerProfile<double>& cutter, const ToolAssembly& tool, double sag_mm);

/// Cutting part, shank and holder, from below.
[[nodiscard]] std::vector<MeshBody> finger_bodies(const FingerProfile<double>& cutter, const ToolAssembly& tool);

}  // namespace toothpath
