#include "cam/gear_cells.h"

#include <algorithm>
#include <cmath>

namespace toothpath {
namespace {

constexpr double kProfileSag = 5e-4;  // mm: of the straight upper borders against the profile
constexpr int kStrips = 48;           // over a pitch, at least: the face is round
constexpr double kQuadHeight = 1.0;   // mm

/// The part of a convex polygon where n.p <= limit.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec3& n, double limit) {
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = n.dot(a) - limit, db = n.dot(b) - limit;
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

/// How far the points between a and b of the profile lie above the line from a to b, and how far below.
std::pair<double, double> beside_chord(const std::vector<Vec2>& profile, std::size_t a, std::size_t b) {
  double above = 0, below = 0;
  const Vec2 d = profile[b] - profile[a];
  for (std::size_t k = a + 1; k < b; ++k) {
    const double t = d.x() != 0 ? std::clamp((profile[k].x() - profile[a].x()) / d.x(), 0.0, 1.0) : 0.5;
    const double dz = profile[k].y() - profile[a].y() - t * d.y();
    above = std::max(above, dz);
    below = std::max(below, -dz);
  }
  return {above, below};
}

}  // namespace

std::vector<Vec3> on_ring(const SpaceSheet& space, std::vector<Vec3> polygon, double sag) {
  const auto& f = space.surface();
  const double r_in = space.ring().zone.inner_radius_mm, r_out = space.ring().zone.outer_radius_mm;
  const auto inside = [&](const Vec3& p) {
    const double r = std::hypot(p.x(), p.y());
    return r >= r_in && r <= r_out && p.z() <= f.z_tip(r);
  };
  if (std::all_of(polygon.begin(), polygon.end(), inside)) return polygon;
  Vec3 centre = Vec3::Zero();
  for (const auto& p : polygon) centre += p / double(polygon.size());
  const Vec3 outwards = Vec3(centre.x(), centre.y(), 0).normalized();
  double across = 0, low = INFINITY, high = 0;  // across: squared distance from the plane through the axis
  for (const auto& p : polygon) {
    const double side = p.cross(outwards).z(), r = std::clamp(std::hypot(p.x(), p.y()), r_in, r_out);
    across = std::max(across, side * side);
    low = std::min(low, r);
    high = std::max(high, r);
  }
  // r lies above r.outwards by at most across / (2 r); a point within the sag of the polygon is a little farther out still.
  const double round = 1.1 * across / (2 * r_in) + 1e-9;
  // The tip surface over the facet lies below a plane that slopes as it does.
  const double slope = high - low > 1e-9 ? (f.z_tip(high) - f.z_tip(low)) / (high - low) : 0;
  const auto over = [&](double r) { return f.z_tip(r) - slope * r; };
  const double middle = over(0.5 * (low + high));
  const double tip = std::max(over(low), over(high)) + 1.2 * std::abs(middle - over(low));
  const double steep = std::sqrt(1 + slope * slope);
  polygon = cut(polygon, Vec3(Vec3::UnitZ() - slope * outwards), tip + std::abs(slope) * round + steep * sag);
  polygon = cut(polygon, outwards, r_out + sag);
  return cut(polygon, -outwards, -r_in + round + sag);
}

std::vector<std::array<Vec3, 4>> end_face_quads(const EndFace& face, const std::vector<Vec2>& profile) {
  std::vector<std::array<Vec3, 4>> quads;
  const double widest = face.pitch / kStrips;
  const auto add = [&](const Vec2& a, const Vec2& b) {
    // Flat quads in front of the round face: the outer one touches it in the middle, the inner one along its borders.
    const double r = face.outer ? face.radius_mm / std::cos(0.5 * (b.x() - a.x())) : face.radius_mm;
    const auto at = [r](double azimuth, double z) { return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z); };
    const double high = std::max(a.y(), b.y());
    const int pieces = std::max(1, int(std::ceil((high - face.base_mm) / kQuadHeight)));
    const auto z = [&](double top, int q) { return face.base_mm + (top - face.base_mm) * q / pieces; };
    for (int q = 0; q < pieces; ++q)
      quads.push_back({at(a.x(), z(a.y(), q)), at(b.x(), z(b.y(), q)), at(a.x(), z(a.y(), q + 1)), at(b.x(), z(b.y(), q + 1))});
  };
  const auto land = [&](double from, double to) {
    const int strips = std::max(1, int(std::ceil((to - from) / widest)));
    for (int k = 0; to > from && k < strips; ++k)
      add({from + (to - from) * k / strips, face.z_tip_mm}, {from + (to - from) * (k + 1) / strips, face.z_tip_mm});
  };
  if (profile.size() < 2) {
    land(face.from, face.from + face.pitch);
    return quads;
  }
  land(face.from, profile.front().x());
  land(profile.back().x(), face.from + face.pitch);
  for (std::size_t a = 0; a + 1 < profile.size();) {
    std::size_t b = a + 1;
    double raise = 0;
    for (std::size_t step = 64; step > 0; step /= 2)
      while (b + step < profile.size() && std::abs(profile[b + step].x() - profile[a].x()) <= widest) {
        const auto [above, below] = beside_chord(profile, a, b + step);
        if (std::max(above, below) > kProfileSag) break;
        raise = above;
        b += step;
      }
    Vec2 from = profile[a], to = profile[b];
    if (from.x() > to.x()) std::swap(from, to);  // below an overhang as well
    from.y() = std::min(from.y() + raise, face.z_tip_mm);
    to.y() = std::min(to.y() + raise, face.z_tip_mm);
    add(from, to);
    a = b;
  }
  return quads;
}

}  // namespace toothpath
