#include "cam/force/engagement.h"

#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::force {
namespace {

/// The piece of the cutting part at a height, level ones passed over; null where there is none.
const tool::MeridianPiece* piece_at(const tool::Meridian& meridian, double h) {
  for (const auto& piece : meridian.pieces())
    if (piece.to[0] > piece.from[0] && piece.from[0] <= h && h <= piece.to[0]) return &piece;
  return nullptr;
}

/// The place of a piece at a height.
Vec2 place_at(const tool::MeridianPiece& piece, double h) { return {h, tool::Meridian({piece}).radius(h)}; }

/// Where the normal of a place meets the axis.
double axis_height(const tool::MeridianPiece& piece, const Vec2& at) {
  const Vec2 n = tool::piece_normal<double>(piece, at);
  return at[0] - at[1] * n[0] / n[1];
}

/// A part of a meridian, from its lower end to a height on it.
struct Part {
  double length = 0, area = 0, half_section = 0;  // int ds, pi int r ds, int r dh
  double steepest = 0;
};

Part part_of(const tool::MeridianPiece& piece, double top) {
  const Vec2 low = piece.from, high = top < piece.to[0] ? place_at(piece, top) : piece.to;
  Part out;
  for (const Vec2& end : {low, high}) out.steepest = std::max(out.steepest, tool::piece_normal<double>(piece, end)[1]);
  if (piece.bend == 0) {
    out.length = (high - low).norm();
    out.area = kPi * out.length * 0.5 * (low[1] + high[1]);
    out.half_section = (high[0] - low[0]) * 0.5 * (low[1] + high[1]);
    return out;
  }
  // r = c_r + s R cos(u), h = c_h + s R sin(u), dh = R cos(u) |du|, s = +-1 where the piece bulges or is hollow.
  const auto c = tool::circle_of<double>(piece);
  const double s = piece.bend > 0 ? 1 : -1, R = c.R;
  const auto sine = [&](const Vec2& p) { return std::clamp((p[0] - c.centre[0]) / R, -1.0, 1.0); };
  const double sine_low = sine(low), sine_high = sine(high), u0 = std::asin(sine_low), u1 = std::asin(sine_high);
  out.length = R * (u1 - u0);
  out.area = kPi * R * (c.centre[1] * (u1 - u0) + s * R * (sine_high - sine_low));
  const auto lens = [](double u, double sine_u) { return 0.5 * (u + sine_u * std::cos(u)); };
  out.half_section = c.centre[1] * R * (sine_high - sine_low) + s * R * R * (lens(u1, sine_high) - lens(u0, sine_low));
  if (u0 < 0 && u1 > 0) out.steepest = 1;
  return out;
}

}  // namespace

Engagement side_engagement(double length_mm, double radius_mm, double height_mm, double stock_mm) {
  Engagement e;
  e.edge_mm = length_mm;
  e.arc_mm = std::sqrt(2 * stock_mm * radius_mm);
  e.radius_mm = radius_mm;
  e.area_mm2 = length_mm * e.arc_mm;
  e.section_mm2 = length_mm * stock_mm;
  e.steepest = e.arc_mm / radius_mm;
  e.height_mm = height_mm;
  return e;
}

Result<Engagement> side_engagement(const tool::Profile& mill, double from_mm, double to_mm, double stock_mm) {
  const double top = mill.cutting().to();
  if (!(from_mm >= 0 && to_mm > from_mm && to_mm <= top))
    return fail("a line from {:.4f} to {:.4f} mm above the tip does not ascend within the cutting part, 0 to {:.4f} mm",
                from_mm, to_mm, top);
  const double middle = 0.5 * (from_mm + to_mm);
  const auto* piece = piece_at(mill.cutting(), middle);
  const Vec2 at = piece ? place_at(*piece, middle) : Vec2::Zero();
  const Vec2 n = piece ? tool::piece_normal<double>(*piece, at) : Vec2::Zero();
  if (!(at[1] > 0 && n[1] > 0)) return fail("the cutting part has no side at {:.4f} mm above the tip", middle);
  const double R = at[1] / n[1];
  if (!(stock_mm > 0 && stock_mm < R))
    return fail("stock of {:.4f} mm is not above 0 and below {:.4f} mm, the radius of the side", stock_mm, R);
  return side_engagement((to_mm - from_mm) / n[1], R, axis_height(*piece, at), stock_mm);
}

double step_of_scallop(double radius_mm, double scallop_mm) {
  return 2 * std::sqrt(scallop_mm * (2 * radius_mm - scallop_mm));
}

Result<Engagement> ball_engagement(double radius_mm, double stock_mm, double step_mm) {
  if (!(stock_mm > 0 && stock_mm < radius_mm))
    return fail("stock of {:.4f} mm is not above 0 and below {:.4f} mm, the radius of the ball", stock_mm, radius_mm);
  if (!(step_mm > 0)) return fail("a step of {:.4f} mm between passes is not above 0", step_mm);
  const double rho = std::sqrt(2 * radius_mm * stock_mm);
  Engagement e;
  e.radius_mm = e.height_mm = radius_mm;
  if (step_mm >= 2 * rho) {  // a groove: half a disc
    e.edge_mm = 2 * rho;
    e.arc_mm = rho;
    e.area_mm2 = 0.5 * kPi * rho * rho;
    e.section_mm2 = 4.0 / 3 * rho * stock_mm;
  } else {
    // Parabola and circle cross at y = rho - w.
    const double w = step_mm, cross = rho - w, at_cross = std::sqrt(w * (2 * rho - w));
    e.edge_mm = w / 2 + rho;
    e.arc_mm = cross > 0 ? at_cross : rho;
    e.area_mm2 = std::sqrt(w) * std::pow(2 * rho - w, 1.5) / 3 +
                 0.5 * (rho * rho * (kPi / 2 - std::asin(cross / rho)) - cross * at_cross);
    e.section_mm2 = w * (stock_mm - w * w / (24 * radius_mm));
  }
  e.steepest = e.arc_mm / radius_mm;
  return e;
}

Result<Engagement> slot_engagement(const tool::Profile& mill, double depth_mm) {
  const tool::Meridian& cutting = mill.cutting();
  if (!(depth_mm > 0 && depth_mm <= cutting.to()))
    return fail("a depth of {:.4f} mm is not above 0 and at most {:.4f} mm, the end of the teeth", depth_mm,
                cutting.to());
  Engagement e;
  for (const auto& piece : cutting.pieces()) {
    if (!(piece.to[0] > piece.from[0]) || piece.from[0] >= depth_mm) continue;
    const Part part = part_of(piece, depth_mm);
    e.edge_mm += part.length;
    e.area_mm2 += part.area;
    e.section_mm2 += 2 * part.half_section;
    e.steepest = std::max(e.steepest, part.steepest);
    e.radius_mm = std::max(
        e.radius_mm,
        tool::Meridian({tool::MeridianPiece{piece.from, depth_mm < piece.to[0] ? place_at(piece, depth_mm) : piece.to,
                                            piece.bend}})
            .largest_radius());
  }
  e.arc_mm = kPi * e.radius_mm;
  const double middle = 0.5 * depth_mm;
  const auto* piece = piece_at(cutting, middle);
  if (!piece) return fail("the cutting part has no side at {:.4f} mm above the tip", middle);
  e.height_mm = axis_height(*piece, place_at(*piece, middle));
  return e;
}

}  // namespace toothpath::force
