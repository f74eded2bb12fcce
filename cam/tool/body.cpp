#include "cam/tool/body.h"

#include <algorithm>
#include <cmath>

namespace toothpath::tool {
std::vector<Frustum> shank_and_holder(const ToolAssembly& tool) {
  std::vector<Frustum> out;
  const double end = tool.holder.empty() ? tool.length_mm : tool.stick_out_mm;
  if (end > tool.flute_length_mm)
    out.push_back({tool.flute_length_mm, end, tool.shank_diameter_mm / 2, tool.shank_diameter_mm / 2, Body::shank});
  double height = tool.stick_out_mm;
  for (const auto& h : tool.holder) {
    out.push_back({height, height + h.height_mm, h.lower_diameter_mm / 2, h.upper_diameter_mm / 2, Body::holder});
    height += h.height_mm;
  }
  return out;
}

double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis) {
  const double flat = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  return tip.z() + std::min(f.from * axis.z() - f.radius_from * flat, f.to * axis.z() - f.radius_to * flat);
}

}  // namespace toothpath::tool
