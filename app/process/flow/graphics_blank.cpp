#include "app/process/flow/graphics_blank.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath::flow {
namespace {

constexpr double kOnAxis = 1e-6;  // mm
constexpr int kSteps = 64;        // along the top of a ring

}  // namespace

std::optional<joints::GraphicsBlank> graphics_blank(const process::GearProcess& gear, const joints::Setup& setup) {
  const Vec3 from = setup.origin_mm - setup.work_offset_at_mm;
  if (from.head<2>().norm() > kOnAxis) return std::nullopt;
  const rest::Blank blank = gear.blank();
  joints::GraphicsBlank out;
  out.bore_mm = out.bottom_mm = std::numeric_limits<double>::infinity();
  out.top_mm = -out.bottom_mm;
  const auto hold = [&](double s, double h) {
    const Vec3 p = from + setup.rotation() * blank.place(s, h, 0);
    const double r = p.head<2>().norm();
    out.radius_mm = std::max(out.radius_mm, r);
    out.bore_mm = std::min(out.bore_mm, r);
    out.bottom_mm = std::min(out.bottom_mm, p.z());
    out.top_mm = std::max(out.top_mm, p.z());
  };
  for (const rest::BlankRing& ring : blank.rings)
    for (int i = 0; i <= kSteps; ++i) {
      const double s = ring.from + (ring.to - ring.from) * i / kSteps;
      hold(s, ring.top(s));
      hold(s, ring.floor);
    }
  for (const auto& corners : blank.corners)
    for (const Vec2& c : corners) hold(c.x(), c.y());
  return out;
}

}  // namespace toothpath::flow
