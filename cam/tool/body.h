// The bodies of a tool assembly as frustums about its axis.
#pragma once

#include <vector>

#include "cam/tool/assembly.h"
#include "geometry/base/vec.h"

namespace toothpath::tool {

class Profile;

/// A truncated cone about the tool axis. Heights from the tip, mm.
struct Frustum {
  double from = 0, to = 0;              ///< heights
  double radius_from = 0, radius_to = 0;
  const char* name = "";                ///< "flute", "shank", "holder"
};

/// Shank and holder, from below; the cutting part is not among them. Of an assembly the shank begins at its flute length.
[[nodiscard]] std::vector<Frustum> shank_and_holder(const ToolAssembly& tool);
[[nodiscard]] std::vector<Frustum> shank_and_holder(const Profile& profile);

/// Lowest z of a frustum.
[[nodiscard]] double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis);

}  // namespace toothpath::tool
