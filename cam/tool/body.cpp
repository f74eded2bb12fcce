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

/// How far a turn by `angle` moves points of the body at a height, at most. Convex in the height.
double moved(const Frustum& f, double height, double pivot, double angle) {
  return angle * std::hypot(height - pivot, std::max(f.radius_from, f.radius_to));
}
double slope_of(const Frustum& f) { return f.to > f.from ? (f.radius_to - f.radius_from) / (f.to - f.from) : 0; }
/// Of a way across to the side, the way along the radius.
double across(const Frustum& f) { return std::hypot(1.0, slope_of(f)); }

}  // namespace

std::vector<Frustum> shank_and_holder(const ToolAssembly& tool) { return cones_of(shank_of(tool), holder_of(tool)); }
std::vector<Frustum> shank_and_holder(const Profile& profile) { return cones_of(profile.shank(), profile.holder()); }

std::optional<Frustum> holder_to_gauge_line(const ToolAssembly& tool) {
  if (tool.holder.empty()) return {};
  double top = tool.stick_out_mm;
  for (const HolderSegment& s : tool.holder) top += s.height_mm;
  if (top >= tool.length_mm) return {};
  const double radius = tool.holder.back().upper_diameter_mm / 2;
  return Frustum{top, tool.length_mm, radius, radius, Body::holder};
}

// A point moves by at most `moved`, which grows by less than `angle` a mm of height. What stays that far inside the two
// planes and the side is in every turned body; what comes that far out holds all of them. Both margins are convex in
// the height, so a straight side between those of the ends is on the safe side of them.
std::optional<Frustum> turned_core(const Frustum& body, double pivot_mm, double angle_rad) {
  Frustum f = body;
  f.from += moved(body, body.from, pivot_mm, angle_rad) / (1 - angle_rad);
  f.to -= moved(body, body.to, pivot_mm, angle_rad) / (1 - angle_rad);
  if (f.from >= f.to) return {};
  const auto radius = [&](double h) {
    return body.radius_from + slope_of(body) * (h - body.from) - across(body) * moved(body, h, pivot_mm, angle_rad);
  };
  for (int halving = 0; halving < 6 && radius(f.to) < 0; ++halving) f.to = 0.5 * (f.from + f.to);
  f.radius_from = radius(f.from);
  f.radius_to = radius(f.to);
  if (f.radius_from < 0 || f.radius_to < 0) return {};
  return f;
}

Frustum turned_hull(const Frustum& body, double pivot_mm, double angle_rad) {
  Frustum f = body;
  f.from -= moved(body, body.from, pivot_mm, angle_rad) / (1 - angle_rad);
  f.to += moved(body, body.to, pivot_mm, angle_rad) / (1 - angle_rad);
  const auto radius = [&](double h) {
    return std::max(0.0, body.radius_from + slope_of(body) * (h - body.from) +
                             across(body) * moved(body, h, pivot_mm, angle_rad) / (1 - angle_rad));
  };
  f.radius_from = radius(f.from);
  f.radius_to = radius(f.to);
  return f;
}

double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis) {
  const double flat = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  return tip.z() + std::min(f.from * axis.z() - f.radius_from * flat, f.to * axis.z() - f.radius_to * flat);
}

}  // namespace toothpath::tool
