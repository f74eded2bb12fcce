#include "geometry/tooth_space/bevel_body.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/base/result.h"
#include "geometry/tooth_space/ring_part.h"

namespace toothpath::tooth_space {
namespace {

constexpr double kBelowRoot = 0.5;  // modules

/// (r, z) below a root at s.
Vec2 end_of_face(const Outline& ring, double s, double root, double module_mm) {
  const double h = root - kBelowRoot * module_mm * s / ring.s_from;  // all shrinks with the cone distance
  return {ring.chart.r(s, h), ring.chart.z(s, h)};
}

}  // namespace

Vec2 BevelBody::back(const Outline& ring) const { return end_of_face(ring, ring.s_from, root_back, module_mm); }
Vec2 BevelBody::front(const Outline& ring) const { return end_of_face(ring, ring.s_to, root_front, module_mm); }

std::optional<Refusal> BevelBody::refusal(const Outline& ring) const {
  const double small = 2 * front(ring).x(), large = 2 * back(ring).x();
  if (!(bore_mm < small))
    return Refusal{
        "bore_diameter",
        fail("bore_diameter = {:.4f} mm is not below {:.4f} mm, the body under the small end", bore_mm, small)};
  if (hub_length_mm > 0 && !(hub_mm > bore_mm && hub_mm < large))
    return Refusal{"hub_diameter", fail("hub_diameter = {:.4f} mm is not between the bore, {:.4f} mm, and {:.4f} mm, "
                                        "the body under the large end",
                                        hub_mm, bore_mm, large)};
  return {};
}

std::array<double, 2> body_ends(const ToothSpace& space, const BevelBody& body) {
  return {body.front(space.outline()).y(), body.back(space.outline()).y() + body.hub_length_mm};
}

ToothedSolid bevel_solid(const ToothSpace& space, const BevelBody& body) {
  const Outline& ring = space.outline();
  const Vec2 front = body.front(ring), back = body.back(ring);
  const double bore = 0.5 * body.bore_mm, hub = 0.5 * body.hub_mm;
  ToothedSolid out;
  out.teeth = body.teeth;
  out.module_mm = body.module_mm;
  out.lowest_root = body.lowest_root;
  out.rings.push_back({&space, 0});
  std::vector<Vec2>& corners = out.corners.emplace_back();
  const auto add = [&](double r, double z) {
    const Vec3 p(r, 0, z);
    corners.emplace_back(ring.chart.along(p), ring.chart.up(p));
  };
  add(front.x(), front.y());
  add(bore, front.y());
  add(bore, back.y() + body.hub_length_mm);
  if (body.hub_length_mm > 0) {
    add(hub, back.y() + body.hub_length_mm);
    add(hub, back.y());
  }
  add(back.x(), back.y());
  return out;
}

std::shared_ptr<const ToothedPart> bevel_part(std::shared_ptr<const ToothSpace> space, const BevelBody& body) {
  return ring_part(std::move(space), {body.teeth, body.module_mm, body.lowest_root, body.bore_mm});
}

}  // namespace toothpath::tooth_space
