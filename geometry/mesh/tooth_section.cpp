#include "geometry/mesh/tooth_section.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"

namespace toothpath::mesh {
namespace {

/// Angles below this many mm of arc are rounding, not a crossing.
constexpr double kArcNoise_mm = 1e-9;
/// A fillet that misses the end of its flank by more than this is on another sheet.
constexpr double kJoin_mm = 1e-7;

Vec3 on_circle(double r, double angle, double z) { return {r * std::cos(angle), r * std::sin(angle), z}; }
double mixed(double a, double b, double t) { return a + t * (b - a); }

/// B at `theta` and radius r, by steps in theta from a solved point when one step does not arrive.
std::optional<double> continued_B(const face_gear::SpaceSheet& sheet, int s, double r, double theta_from, double B_from,
                                  double theta, int steps) {
  double B = B_from;
  for (int k = 1; k <= steps; ++k) {
    const auto next = sheet.B_at_radius(s, mixed(theta_from, theta, double(k) / steps), r, B);
    if (!next) return {};
    B = *next;
  }
  return B;
}

}  // namespace

Piece segment_patch(std::size_t segment) {
  constexpr std::array<Piece, kSegmentCount> kPatches{Piece::tip,  Piece::flank_plus,   Piece::fillet_plus,
                                                      Piece::root, Piece::fillet_minus, Piece::flank_minus,
                                                      Piece::tip};
  return kPatches[segment];
}

Result<ToothSection::Side> ToothSection::make_side(const face_gear::SpaceSheet& sheet, int s, double r,
                                                   const Side* near) {
  const auto& f = sheet.surface();
  std::optional<face_gear::FlankCoordinates> start;
  if (near) start = face_gear::FlankCoordinates{near->theta_tip, near->B_tip, 0};
  const double z_tip = f.z_tip(r);
  const auto tip = sheet.invert(s, r, z_tip, start);
  if (!tip)
    return fail("flank {:+d} does not reach the tip surface at radius {:.4f} mm (height {:.4f} mm)", s, r, z_tip);
  Side side;
  side.s = s;
  side.theta_tip = tip->theta;
  side.B_tip = tip->B;
  const double theta_t = f.shaper.theta_t;
  if (side.theta_tip >= theta_t)
    return fail("flank {:+d} has no involute at radius {:.4f} mm: its fillet reaches the tip surface", s, r);
  const int steps = std::max(4, int(std::ceil((theta_t - side.theta_tip) / 0.05)));
  const auto B_t = continued_B(sheet, s, r, side.theta_tip, side.B_tip, theta_t, steps);
  if (!B_t) return fail("flank {:+d} does not reach its fillet at radius {:.4f} mm: undercut", s, r);
  side.B_t = *B_t;

  const double A_t = f.shaper.A_t, A_e = f.shaper.A_e;
  const auto Z_t = sheet.Z_at_radius(s, A_t, r, f.flank_Z(s, theta_t, side.B_t));
  if (!Z_t || (sheet.fillet(s, A_t, *Z_t) - sheet.flank(s, theta_t, side.B_t).p).norm() > kJoin_mm)
    return fail("fillet {:+d} does not join its flank at radius {:.4f} mm: undercut", s, r);
  side.Z_t = side.Z_e = *Z_t;
  const int fillet_steps = std::max(4, int(std::ceil((A_e - A_t) / 0.1)));
  for (int k = 1; k <= fillet_steps; ++k) {
    const auto Z =
        sheet.Z_at_radius(s, k == fillet_steps ? A_e : mixed(A_t, A_e, double(k) / fillet_steps), r, side.Z_e);
    if (!Z) return fail("fillet {:+d} does not reach the root at radius {:.4f} mm", s, r);
    side.Z_e = *Z;
  }
  return side;
}

Result<ToothSection> ToothSection::at(const face_gear::SpaceSheet& sheet, int teeth, double r,
                                      const ToothSection* near) {
  ToothSection section;
  section.sheet_ = &sheet;
  section.teeth_ = teeth;
  section.r_ = r;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto side = make_side(sheet, k == 0 ? 1 : -1, r, near ? &near->sides_[k] : nullptr);
    if (!side) return side.error();
    section.sides_[k] = *side;
    section.root_edge_[k] = section.placed(sheet.fillet(side->s, sheet.surface().shaper.A_e, side->Z_e), side->s);
  }
  const Side &plus = section.sides_[0], &minus = section.sides_[1];
  const Vec3 tip_plus = sheet.flank(1, plus.theta_tip, plus.B_tip).p,
             tip_minus = sheet.flank(-1, minus.theta_tip, minus.B_tip).p;
  const double land = angle_from_to(tip_minus, tip_plus);
  if (land * r < -kArcNoise_mm)
    return fail("top land = {:.6f} mm at radius {:.4f} mm is below 0: the tooth is pointed", land * r, r);
  section.half_land_ = 0.5 * std::max(land, 0.0);
  section.mid_azimuth_ = azimuth(tip_plus) - section.half_land_;
  const double root = angle_from_to(section.root_edge_[0], section.root_edge_[1]);
  if (root * r < -kArcNoise_mm)
    return fail("root land = {:.6f} mm at radius {:.4f} mm is below 0: the fillets overlap", root * r, r);
  section.root_width_ = std::max(root, 0.0);
  return section;
}

std::optional<SectionPoint> ToothSection::flank_point(const Side& side, double from_tip) const {
  const double theta_t = sheet_->surface().shaper.theta_t;
  double theta = mixed(side.theta_tip, theta_t, from_tip), B = mixed(side.B_tip, side.B_t, from_tip);
  if (from_tip <= 0) {
    theta = side.theta_tip;
    B = side.B_tip;
  } else if (from_tip >= 1) {
    theta = theta_t;
    B = side.B_t;
  } else {
    auto solved = sheet_->B_at_radius(side.s, theta, r_, B);
    if (!solved) solved = continued_B(*sheet_, side.s, r_, side.theta_tip, side.B_tip, theta, 32);
    if (!solved) return {};
    B = *solved;
  }
  return SectionPoint{placed(sheet_->flank(side.s, theta, B).p, side.s), {theta, B}};
}

std::optional<SectionPoint> ToothSection::fillet_point(const Side& side, double from_flank) const {
  const auto& w = sheet_->surface().shaper;
  const double A_t = w.A_t, A_e = w.A_e;
  if (from_flank <= 0)  // the flank's own bits
    return SectionPoint{placed(sheet_->flank(side.s, w.theta_t, side.B_t).p, side.s), {A_t, side.Z_t}};
  if (from_flank >= 1) return SectionPoint{root_edge_[side.s > 0 ? 0 : 1], {A_e, side.Z_e}};
  const double A = mixed(A_t, A_e, from_flank);
  const auto Z = sheet_->Z_at_radius(side.s, A, r_, mixed(side.Z_t, side.Z_e, from_flank));
  if (!Z) return {};
  return SectionPoint{placed(sheet_->fillet(side.s, A, *Z), side.s), {A, *Z}};
}

std::optional<SectionPoint> ToothSection::point(std::size_t segment, double fraction) const {
  const Side &plus = sides_[0], &minus = sides_[1];
  switch (Segment(segment)) {
    case Segment::flank_plus: return flank_point(plus, fraction);
    case Segment::fillet_plus: return fillet_point(plus, fraction);
    case Segment::fillet_minus: return fillet_point(minus, 1 - fraction);
    case Segment::flank_minus: return flank_point(minus, 1 - fraction);
    case Segment::root: {
      SectionPoint end{root_edge_[fraction < 0.5 ? 0 : 1], {fraction, plus.Z_e}};
      if (fraction > 0 && fraction < 1) { end.p = turned(root_edge_[0], fraction * root_width_); }
      return end;
    }
    case Segment::land_left: {
      const double angle = mid_azimuth_ + fraction * half_land_;
      if (fraction >= 1) return SectionPoint{flank_point(plus, 0)->p, {angle, r_}};
      return SectionPoint{on_circle(r_, angle, sheet_->surface().z_tip(r_)), {angle, r_}};
    }
    case Segment::land_right: {
      const double angle = mid_azimuth_ - (1 - fraction) * half_land_ + sheet_->surface().pitch;
      if (fraction <= 0) return SectionPoint{flank_point(minus, 0)->p, {angle, r_}};
      if (fraction >= 1)
        return SectionPoint{placed(on_circle(r_, mid_azimuth_, sheet_->surface().z_tip(r_)), -1), {angle, r_}};
      return SectionPoint{on_circle(r_, angle, sheet_->surface().z_tip(r_)), {angle, r_}};
    }
  }
  return {};
}

}  // namespace toothpath::mesh
