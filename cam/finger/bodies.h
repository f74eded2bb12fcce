// The bodies of a finger mill assembly as meshes are asked: cutting part, shank, holder.
#pragma once

#include <vector>

#include "cam/clearance/clearance.h"
#include "cam/finger/finger_profile.h"

namespace toothpath::finger {

/// Cutting part, shank and holder, from below, as truncated cones; the flank's chords leave it by 1 um.
[[nodiscard]] inline std::vector<clearance::MeshBody> finger_bodies(const bevel_gear::FingerProfile<double>& cutter,
                                                                    const tool::ToolAssembly& tool) {
  return clearance::mesh_bodies(finger_profile(cutter, tool, 1e-3));
}

}  // namespace toothpath::finger
