#include "cam/tool_body.h"

#include <algorithm>
#include <cmath>

namespace toothpath {
namespace {


}  // namespace

std::vector<Frustum> shank_and_holder(const ToolAssembly& tool) {
  std::vector<Frustum> out;
  const double end = tool.holder.empty() ? tool.length_mm : tool.stick_out_mm;
  if (end > tool.flute_length_mm)
    out.push_back({tool.flute_length_mm, end, tool.shank_diameter_mm / 2, tool.shank_diameter_mm / 2, "shank"});
  double height = tool.stick_out_mm;
  for (const auto& h : tool.holder) {
    out.push_back({height, height + h.height_mm, h.lower_diameter_mm / 2, h.upper_diameter_mm / 2, "holder"});
    height += h.height_mm;
  }
  return out;
}

double distance_to_frustum(const Vec3& point, const Frustum& f, const Vec3& tip, const Vec3& axis) {
  const Vec3 d = point - tip;
  const double h = d.dot(axis), rho = (d - h * axis).norm();
  // In the half plane (rho, h): a convex quadrilateral between the axis and the generator.
  const double length = f.to - f.from;
  if (h >= f.from && h <= f.to) {
    const double t = length > 0 ? (h - f.from) / length : 0;
    if (rho <= f.radius_from + t * (f.radius_to - f.radius_from)) return 0;
  }
  const auto to_segment = [&](double r0, double h0, double r1, double h1) {
    const double dr = r1 - r0, dh = h1 - h0, l2 = dr * dr + dh * dh;
    const double t = l2 > 0 ? std::clamp(((rho - r0) * dr + (h - h0) * dh) / l2, 0.0, 1.0) : 0.0;
    return std::hypot(rho - r0 - t * dr, h - h0 - t * dh);
  };
  return std::min({to_segment(0, f.from, f.radius_from, f.from), to_segment(f.radius_from, f.from, f.radius_to, f.to),
                   to_segment(0, f.to, f.radius_to, f.to)});
}

double triangle_gap(const Vec3& a, const Vec3& b, const Vec3& c, const Frustum& f, const Vec3& tip, const Vec3& axis,
                    double best, double resolution, int depth) {
  if (best <= -resolution) return best;  // inside: how deep does not matter
  const Vec3 centre = (a + b + c) / 3;
  const double size = std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
  const double d = distance_to_frustum(centre, f, tip, axis);
  if (d - size >= best) return best;
  if (d == 0) return std::min(best, -resolution);
  if (size <= resolution || depth == 0) return std::min(best, d - size);
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  best = triangle_gap(ab, bc, ca, f, tip, axis, best, resolution, depth - 1);
  best = triangle_gap(a, ab, ca, f, tip, axis, best, resolution, depth - 1);
  best = triangle_gap(ab, b, bc, f, tip, axis, best, resolution, depth - 1);
  return triangle_gap(ca, bc, c, f, tip, axis, best, resolution, depth - 1);
}

double lowest_z(const Frustum& f, const Vec3& tip, const Vec3& axis) {
  const double flat = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
  return tip.z() + std::min(f.from * axis.z() - f.radius_from * flat, f.to * axis.z() - f.radius_to * flat);
}

BodyGap body_gap(const GearDistance& part, const Frustum& f, const Vec3& tip, const Vec3& axis, double enough,
                 double resolution_mm) {
  BodyGap best{enough, 0, tip};
  const double above = lowest_z(f, tip, axis) - part.gear().blank_top();
  if (above >= enough) return best;
  const double widest = std::max(f.radius_from, f.radius_to);
  const int links = std::max(1, int(std::ceil((f.to - f.from) / std::max(widest, 0.5))));
  const double half = 0.5 * (f.to - f.from) / links;
  const double pitch = part.gear().pitch();
  for (int zone = 0; zone < part.zones(); ++zone) {
    const auto& cells = part.cells(zone);
    const auto& triangles = part.triangles(zone);
    for (int k = 0; k < links; ++k) {
      const Vec3 x = tip + axis * (f.from + (2 * k + 1) * half);
      const double r = std::max(std::hypot(x.x(), x.y()), 1.0);
      const double reach = std::hypot(widest, half) + enough + part.cell_sag_mm();
      const auto& ring = part.space(zone).ring().zone;
      // The groove floor belongs to the ring inside it.
      const double end = zone + 1 < part.zones() ? part.space(zone + 1).ring().zone.inner_radius_mm : ring.outer_radius_mm;
      if (r + reach < ring.inner_radius_mm || r - reach > end) continue;
      const double azimuth = std::remainder(std::atan2(x.y(), x.x()) - part.space_azimuth(zone, r), 6.283185307179586);
      const int index = int(std::lround(azimuth / pitch));
      const int wide = 1 + int(std::ceil(reach / (pitch * ring.inner_radius_mm)));
      for (int tooth = index - wide; tooth <= index + wide; ++tooth) {
        const double turn = -tooth * pitch;
        const Vec3 tip_0 = turned(tip, turn), axis_0 = turned(axis, turn), x_0 = turned(x, turn);
        part.cell_index(zone).near(x_0, reach, [&](std::size_t c, double radius) {
          const auto& cell = cells[c];
          if (distance_to_frustum(cell.centre, f, tip_0, axis_0) - cell.radius >= best.gap) return radius;
          double gap = best.gap + part.cell_sag_mm();
          for (std::uint32_t q = cell.first_triangle; q < cell.first_triangle + cell.triangles; ++q)
            gap = triangle_gap(triangles[q][0], triangles[q][1], triangles[q][2], f, tip_0, axis_0, gap, resolution_mm, 8);
          gap -= part.cell_sag_mm();
          if (gap < best.gap) best = {gap, zone, cell.centre};
          return radius;
        });
      }
    }
  }
  best.gap = std::max(best.gap, above);  // the whole part lies below: that height is a proven gap too
  return best;
}

}  // namespace toothpath
