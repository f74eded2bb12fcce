// The bodies of a tool assembly as frustums about its axis.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cam/tool/assembly.h"
#include "geometry/base/vec.h"

namespace toothpath::tool {

class Profile;

/// The bodies of a tool, as messages and reports name them. `cutter`: ball and flute in one; `any`: of a rapid,
/// whichever comes first.
enum class Body : std::uint8_t { none, ball, flute, cutter, shank, holder, any };
[[nodiscard]] constexpr const char* to_string(Body body) {
  switch (body) {
    case Body::none: return "";
    case Body::ball: return "ball";
    case Body::flute: return "flute";
    case Body::cutter: return "cutter";
    case Body::shank: return "shank";
    case Body::holder: return "holder";
    case Body::any: return "rapid";
  }
  return "";
}
/// Does it cut? What it does to the part is a gouge, not a lack of clearance.
[[nodiscard]] constexpr bool cuts(Body body) {
  return body == Body::ball || body == Body::flute || body == Body::cutter;
}

/// A truncated cone about the tool axis. Heights from the tip, mm.
struct Frustum {
  double from = 0, to = 0;  ///< heights
  double radius_from = 0, radius_to = 0;
  Body body = Body::none;
};

/// Shank and holder, from below; the cutting part is not among them. Of an assembly the shank begins at its flute
/// length.
[[nodiscard]] std::vector<Frustum> shank_and_holder(const ToolAssembly& tool);
[[nodiscard]] std::vector<Frustum> shank_and_holder(const Profile& profile);

/// What lies between the top of the stated holder and the gauge line, where the spindle nose stands: there the last
/// diameter of the holder goes on. None: there is no holder, or it reaches the gauge line.
[[nodiscard]] std::optional<Frustum> holder_to_gauge_line(const ToolAssembly& tool);

/// What a body has in common under all axes within `angle_rad` (< 1) of its own, turned about the point `pivot_mm`
/// above the tip: a frustum inside of it, on its own axis. None where nothing is left that a frustum holds.
[[nodiscard]] std::optional<Frustum> turned_core(const Frustum& body, double pivot_mm, double angle_rad);
/// A frustum that holds the body under all of them.
[[nodiscard]] Frustum turned_hull(const Frustum& body, double pivot_mm, double angle_rad);

/// Lowest z of a frustum.
[[nodiscard]] double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis);

}  // namespace toothpath::tool

/// Bodies in formatted text.
template <>
struct fmt::formatter<toothpath::tool::Body> : fmt::formatter<std::string_view> {
  template <typename Context>
  auto format(toothpath::tool::Body body, Context& context) const {
    return fmt::formatter<std::string_view>::format(to_string(body), context);
  }
};
