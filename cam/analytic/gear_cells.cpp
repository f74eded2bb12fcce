#include "cam/analytic/gear_cells.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace toothpath::analytic {
namespace {

constexpr double kProfileSag = 5e-4;  // mm: of the straight upper borders against the profile
constexpr int kStrips = 48;           // over a pitch, at least: a face may be round
constexpr double kQuadHeight = 1.0;   // mm

/// The part of a facet where n.p <= limit.
Facet cut(const Facet& facet, const Vec3& n, double limit) {
  Facet out;
  for (std::size_t k = 0; k < facet.count; ++k) {
    const FacetCorner &a = facet.corner[k], &b = facet.corner[(k + 1) % facet.count];
    const double da = n.dot(a.p) - limit, db = n.dot(b.p) - limit;
    if (da <= 0) out.add(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      const double share = da / (da - db);
      out.add({a.p + (b.p - a.p) * share, a.at + (b.at - a.at) * share, false});
    }
  }
  return out;
}

}  // namespace

bool on_ring(const tooth_space::ToothSpace& space, const Vec3& p, double slack) {
  const auto& ring = space.outline();
  const double s = ring.chart.along(p);
  return s >= ring.s_from - slack && s <= ring.s_to + slack && ring.chart.up(p) <= space.tip(s) + slack;
}

Facet on_ring(const tooth_space::ToothSpace& space, const Facet& facet, double sag) {
  const auto& ring = space.outline();
  const tooth_space::Chart& chart = ring.chart;
  const auto corners = std::span(facet.corner).first(facet.count);
  if (std::all_of(corners.begin(), corners.end(), [&](const FacetCorner& c) { return on_ring(space, c.p); }))
    return facet;
  Vec3 centre = Vec3::Zero();
  for (const auto& c : corners) centre += c.p / double(facet.count);
  const Vec3 outwards = Vec3(centre.x(), centre.y(), 0).normalized();
  double across = 0, low = INFINITY, high = -INFINITY;  // across: squared distance from the plane through the axis
  double least_radius = INFINITY;                       // in that plane
  for (const auto& c : corners) {
    const double side = c.p.cross(outwards).z(), s = std::clamp(chart.along(c.p), ring.s_from, ring.s_to);
    across = std::max(across, side * side);
    low = std::min(low, s);
    high = std::max(high, s);
    least_radius = std::min(least_radius, c.p.dot(outwards));
  }
  if (chart.sine == 0) least_radius = ring.s_from;
  // The radius of a place lies above its part along `outwards` by at most across / (2 r); a point within the sag of the
  // polygon is a little farther out still.
  const double round = 1.1 * across / (2 * least_radius) + 1e-9;
  // The tip surface over the facet lies below a plane that slopes as it does.
  const double slope = high - low > 1e-9 ? (space.tip(high) - space.tip(low)) / (high - low) : 0;
  const auto over = [&](double s) { return space.tip(s) - slope * s; };
  const double middle = over(0.5 * (low + high));
  const double bent = 0.125 * (high - low) * (high - low) * space.tip_bend(low, high).bend.magnitude();
  const double tip = std::max(over(low), over(high)) + std::max(1.2 * std::abs(middle - over(low)), bent);
  const double steep = std::sqrt(1 + slope * slope);
  const Vec3 along = chart.cosine * outwards - chart.sine * Vec3::UnitZ(),
             up = chart.sine * outwards + chart.cosine * Vec3::UnitZ();
  // s of a place lies above its part along `along` where that points outwards, below it where it points inwards.
  const double rises = std::max(chart.cosine, 0.0) * round, falls = std::max(-chart.cosine, 0.0) * round;
  Facet out = cut(facet, Vec3(up - slope * along), tip + std::abs(slope) * (rises + falls) + steep * sag);
  out = cut(out, along, ring.s_to + falls + sag);
  return cut(out, -along, -ring.s_from + rises + sag);
}

Vec2 border_place(const std::vector<Vec2>& border, double at) {
  const auto k = std::min(std::size_t(std::max(at, 0.0)), border.size() - 2);
  const double share = at - double(k);
  return share >= 1 ? border[k + 1] : Vec2(border[k] + share * (border[k + 1] - border[k]));
}

BorderStretch border_stretch(const std::vector<Vec2>& border, double from, double to) {
  BorderStretch s;
  s.from = border_place(border, from);
  s.to = border_place(border, to);
  s.least_azimuth = std::min(s.from.x(), s.to.x());
  s.most_azimuth = std::max(s.from.x(), s.to.x());
  const Vec2 d = s.to - s.from;
  for (auto k = std::size_t(from) + 1; double(k) < to; ++k) {
    const double t = d.x() != 0 ? std::clamp((border[k].x() - s.from.x()) / d.x(), 0.0, 1.0) : 0.5;
    const double dz = border[k].y() - s.from.y() - t * d.y();
    s.above = std::max(s.above, dz);
    s.below = std::max(s.below, -dz);
    s.least_azimuth = std::min(s.least_azimuth, border[k].x());
    s.most_azimuth = std::max(s.most_azimuth, border[k].x());
  }
  return s;
}

std::vector<Vec2> end_border(const EndFace& face, const std::vector<Vec2>& profile) {
  std::vector<Vec2> border{{face.from, face.tip_mm}};
  if (profile.size() >= 2) border.insert(border.end(), profile.begin(), profile.end());
  border.push_back({face.from + face.pitch, face.tip_mm});
  return border;
}

std::vector<EndQuad> end_face_quads(const EndFace& face, const std::vector<Vec2>& profile) {
  std::vector<EndQuad> quads;
  const double widest = face.pitch / kStrips;
  const auto add = [&](const Vec2& a, const Vec2& b, double from, double to) {
    // Flat quads in front of a round face: of a hollow one they touch it along their borders, of another in the middle.
    const double round =
        (face.outer ? face.chart.cosine : -face.chart.cosine) > 0 ? std::cos(0.5 * (b.x() - a.x())) : 1;
    const auto at = [&](double azimuth, double h) {
      const double r = face.chart.r(face.s_mm, h) / round;
      return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), face.chart.z(face.s_mm, h));
    };
    const double high = std::max(a.y(), b.y());
    const int pieces = std::max(1, int(std::ceil((high - face.base_mm) / kQuadHeight)));
    const auto level = [&](double top, int q) { return face.base_mm + (top - face.base_mm) * q / pieces; };
    for (int q = 0; q < pieces; ++q)
      quads.push_back({{at(a.x(), level(a.y(), q)), at(b.x(), level(b.y(), q)), at(a.x(), level(a.y(), q + 1)),
                        at(b.x(), level(b.y(), q + 1))},
                       from,
                       to,
                       double(q) / pieces,
                       double(q + 1) / pieces});
  };
  // A stretch of land, which is one piece of the border.
  const auto land = [&](double from, double to, double piece) {
    const int strips = std::max(1, int(std::ceil((to - from) / widest)));
    for (int k = 0; to > from && k < strips; ++k)
      add({from + (to - from) * k / strips, face.tip_mm}, {from + (to - from) * (k + 1) / strips, face.tip_mm},
          piece + double(k) / strips, piece + double(k + 1) / strips);
  };
  if (profile.size() < 2) {
    land(face.from, face.from + face.pitch, 0);
    return quads;
  }
  land(face.from, profile.front().x(), 0);
  land(profile.back().x(), face.from + face.pitch, double(profile.size()));
  for (std::size_t a = 0; a + 1 < profile.size();) {
    std::size_t b = a + 1;
    double raise = 0;
    for (std::size_t step = 64; step > 0; step /= 2)
      while (b + step < profile.size() && std::abs(profile[b + step].x() - profile[a].x()) <= widest) {
        const auto stretch = border_stretch(profile, double(a), double(b + step));
        if (std::max(stretch.above, stretch.below) > kProfileSag) break;
        raise = stretch.above;
        b += step;
      }
    Vec2 from = profile[a], to = profile[b];
    if (from.x() > to.x()) std::swap(from, to);  // below an overhang as well
    from.y() = std::min(from.y() + raise, face.tip_mm);
    to.y() = std::min(to.y() + raise, face.tip_mm);
    add(from, to, double(a + 1), double(b + 1));
    a = b;
  }
  return quads;
}

}  // namespace toothpath::analytic
