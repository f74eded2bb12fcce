#include "cam/tool/body.h"

#include <algorithm>
#include <cmath>

#include "cam/tool/profile.h"

namespace toothpath::tool {

namespace {

/// Both consist of lines: cones are exact.
std::vector<Frustum> cones_of(const Meridian& shank, const Meridian& holder) {
  std::vector<Frustum> out = shank.enclosing_frustums(0, Body::shank);
  for (const Frustum& f : holder.enclosing_frustums(0, Body::holder)) out.push_back(f);
  return out;
}

}  // namespace

std::vector<Frustum> shank_and_holder(const ToolAssembly& tool) { return cones_of(shank_of(tool), holder_of(tool)); }
std::vector<Frustum> shank_and_holder(const Profile& profile) { return cones_of(profile.shank(), profile.holder()); }

double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis) {
  const double flat = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  return tip.z() + std::min(f.from * axis.z() - f.radius_from * flat, f.to * axis.z() - f.radius_to * flat);
}

}  // namespace toothpath::tool
