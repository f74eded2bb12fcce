#include "geometry/mesh/tooth_section.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::mesh {
namespace {

using tooth_space::Borders;
using tooth_space::ToothSpace;

/// Angles below this many mm of arc are rounding, not a crossing.
constexpr double kArcNoise_mm = 1e-9;
/// A fillet that misses the end of its flank by more than this is on another sheet.
constexpr double kJoin_mm = 1e-7;
constexpr int kSteps = 12;  // along a piece from one end to the other
constexpr double kOnStation = 1e-13;

double mixed(double a, double b, double t) { return a + t * (b - a); }

/// v at `u_to` of the line of a piece at station s, in steps from a solved place.
std::optional<double> followed(const ToothSpace& space, Piece piece, double s, double u_from, double v_from,
                               double u_to, int steps) {
  const auto& chart = space.outline().chart;
  double u = u_from, v = v_from;
  for (int k = 1; k <= steps; ++k) {
    const auto q = space.at(piece, u, v);
    if (!q) return {};
    const double next = k == steps ? u_to : mixed(u_from, u_to, double(k) / steps);
    const double slope = -chart.along(q->p, q->pu) / chart.along(q->p, q->pv);
    const auto solved = v_at_station(space, piece, next, s, std::isfinite(slope) ? v + slope * (next - u) : v);
    if (!solved) return {};
    u = next;
    v = *solved;
  }
  return v;
}

/// v of a piece at station s where no place of it is known; the first solved one that `fits` counts.
template <typename Fits>
std::optional<double> first_v(const ToothSpace& space, Piece piece, double u, double s,
                              const std::optional<tooth_space::Near>& near, const Fits& fits) {
  for (int attempt = 0; attempt < ToothSpace::kStarts; ++attempt) {
    const auto start = space.start_v(piece, u, s, 0, near, attempt);
    if (!start) continue;
    const auto v = v_at_station(space, piece, u, s, *start);
    if (v && fits(*v)) return v;
  }
  return {};
}

}  // namespace

std::optional<double> v_at_station(const ToothSpace& space, Piece piece, double u, double s, double start) {
  constexpr int kMostSteps = 40;
  const auto& chart = space.outline().chart;
  double v = start;
  const auto first = space.at(piece, u, v);
  if (!first) return {};
  double slope = chart.along(first->p, first->pv), lack = s - chart.along(first->p);
  const double enough = kOnStation * first->p.norm(), longest = space.longest_step(piece, s);
  for (int k = 0; k < kMostSteps; ++k) {
    if (std::abs(lack) <= enough) return v;
    const double step = std::clamp(lack / slope, -longest, longest);
    if (!std::isfinite(step)) return {};
    const auto next = space.point(piece, u, v + step);
    if (!next) return {};
    const double left = s - chart.along(next->p);
    // Rounding: nothing nearer is found.
    if (std::abs(left) >= 0.5 * std::abs(lack) && std::abs(lack) <= 100 * enough) return v;
    if (std::abs(left) > 100 * enough) slope = (lack - left) / step;
    v += step;
    lack = left;
  }
  return {};
}

Piece segment_patch(std::size_t segment) {
  constexpr std::array<Piece, kSegmentCount> kPatches{Piece::tip,  Piece::flank_plus,   Piece::fillet_plus,
                                                      Piece::root, Piece::fillet_minus, Piece::flank_minus,
                                                      Piece::tip};
  return kPatches[segment];
}

std::string ToothSection::station() const { return tooth_space::station(space_->outline(), s_); }

Result<ToothSection::Side> ToothSection::make_side(const ToothSpace& space, int side, double s,
                                                   const ToothSection* near) {
  const Side* before = near ? &near->sides_[side > 0 ? 0 : 1] : nullptr;
  std::optional<tooth_space::EdgePlace> start;
  if (before) start = tooth_space::EdgePlace{before->u_tip, before->v_tip, before->azimuth_tip};
  const auto tip = space.tip_edge(side, s, start);
  const auto where = [&] { return tooth_space::station(space.outline(), s); };
  if (!tip)
    return fail("flank {:+d} does not reach the tip surface at {} (height {:.4f} mm)", side, where(), space.tip(s));
  const Piece flank = tooth_space::flank_of(side), fillet = tooth_space::fillet_of(side);
  const Borders of_flank = space.borders(flank), of_fillet = space.borders(fillet);
  Side out{side, tip->u, tip->v, tip->azimuth, 0, 0, 0, 0, 0, 0};
  out.u_end = side > 0 ? of_flank.to : of_flank.from;
  out.u_join = side > 0 ? of_fillet.from : of_fillet.to;
  out.u_root = side > 0 ? of_fillet.to : of_fillet.from;
  // On its tip's side a flank has no border.
  const bool grows = (side > 0 ? of_flank.from : of_flank.to) < 0;
  if (grows ? out.u_tip >= out.u_end : out.u_tip <= out.u_end)
    return fail("flank {:+d} has no involute at {}: its fillet reaches the tip surface", side, where());
  const auto v_end = followed(space, flank, s, out.u_tip, out.v_tip, out.u_end, kSteps);
  const auto end = v_end ? space.point(flank, out.u_end, *v_end) : std::nullopt;
  if (!end) return fail("flank {:+d} does not reach its fillet at {}: undercut", side, where());
  out.v_end = *v_end;
  std::optional<tooth_space::Near> joined;
  if (before) joined = tooth_space::Near{before->v_join, near->s_};
  const auto v_join = first_v(space, fillet, out.u_join, s, joined, [&](double v) {
    const auto q = space.point(fillet, out.u_join, v);
    return q && (q->p - end->p).norm() <= kJoin_mm;
  });
  if (!v_join) return fail("fillet {:+d} does not join its flank at {}: undercut", side, where());
  out.v_join = *v_join;
  const auto v_root = followed(space, fillet, s, out.u_join, out.v_join, out.u_root, kSteps);
  if (!v_root) return fail("fillet {:+d} does not reach the root at {}", side, where());
  out.v_root = *v_root;
  return out;
}

Result<ToothSection> ToothSection::at(const ToothSpace& space, double s, const ToothSection* near) {
  ToothSection section;
  section.space_ = &space;
  section.s_ = s;
  for (std::size_t k = 0; k < 2; ++k) {
    const int sign = k == 0 ? 1 : -1;
    const auto side = make_side(space, sign, s, near);
    if (!side) return side.error();
    section.sides_[k] = *side;
    section.tip_edge_[k] = space.point(tooth_space::flank_of(sign), side->u_tip, side->v_tip)->p;
    section.root_edge_[k] = space.point(tooth_space::fillet_of(sign), side->u_root, side->v_root)->p;
  }
  const double pitch = space.outline().pitch, at_tip = radius(section.tip_edge_[0]),
               at_root = radius(section.root_edge_[0]);
  const double land = pitch - angle_from_to(section.tip_edge_[0], section.tip_edge_[1]);
  if (land * at_tip < -kArcNoise_mm)
    return fail("top land = {:.6f} mm at {} is below 0: the tooth is pointed", land * at_tip, section.station());
  section.half_land_ = 0.5 * std::max(land, 0.0);
  section.mid_azimuth_ = azimuth(section.tip_edge_[0]) - section.half_land_;
  const double root = angle_from_to(section.root_edge_[0], section.root_edge_[1]);
  if (root * at_root < -kArcNoise_mm)
    return fail("root land = {:.6f} mm at {} is below 0: the fillets overlap", root * at_root, section.station());
  section.root_width_ = std::max(root, 0.0);
  if (root * at_root > kArcNoise_mm) {
    const Borders of_root = space.borders(Piece::root);
    std::optional<tooth_space::Near> before;
    if (near) before = tooth_space::Near{near->root_v_, near->s_};
    const auto v =
        first_v(space, Piece::root, mixed(of_root.from, of_root.to, 0.5), s, before, [](double) { return true; });
    if (!v) return fail("the root is not defined at {}", section.station());
    section.root_v_ = *v;
  }
  return section;
}

std::optional<SectionPoint> ToothSection::flank_point(const Side& side, double from_tip) const {
  const Piece piece = tooth_space::flank_of(side.s);
  if (from_tip <= 0) return SectionPoint{tip_edge_[side.s > 0 ? 0 : 1], {side.u_tip, side.v_tip}};
  double u = side.u_end, v = side.v_end;
  if (from_tip < 1) {
    u = mixed(side.u_tip, side.u_end, from_tip);
    auto solved = v_at_station(*space_, piece, u, s_, mixed(side.v_tip, side.v_end, from_tip));
    if (!solved) solved = followed(*space_, piece, s_, side.u_tip, side.v_tip, u, 2 * kSteps);
    if (!solved) return {};
    v = *solved;
  }
  const auto q = space_->point(piece, u, v);
  if (!q) return {};
  return SectionPoint{q->p, {u, v}};
}

std::optional<SectionPoint> ToothSection::flank_at(int side, double u) const {
  const Side& of = sides_[side > 0 ? 0 : 1];
  return flank_point(of, (u - of.u_tip) / (of.u_end - of.u_tip));
}

std::optional<SectionPoint> ToothSection::fillet_point(const Side& side, double from_flank) const {
  if (from_flank <= 0) {  // the flank's own bits
    const auto end = flank_point(side, 1);
    if (!end) return {};
    return SectionPoint{end->p, {side.u_join, side.v_join}};
  }
  if (from_flank >= 1) return SectionPoint{root_edge_[side.s > 0 ? 0 : 1], {side.u_root, side.v_root}};
  const Piece piece = tooth_space::fillet_of(side.s);
  const double u = mixed(side.u_join, side.u_root, from_flank);
  const auto v = v_at_station(*space_, piece, u, s_, mixed(side.v_join, side.v_root, from_flank));
  const auto q = v ? space_->point(piece, u, *v) : std::nullopt;
  if (!q) return {};
  return SectionPoint{q->p, {u, *v}};
}

std::optional<SectionPoint> ToothSection::root_point(double fraction) const {
  const Borders of_root = space_->borders(Piece::root);
  const double u = mixed(of_root.from, of_root.to, fraction);
  const bool none = root_width_ * radius(root_edge_[0]) <= kArcNoise_mm;
  if (none || fraction <= 0 || fraction >= 1)
    return SectionPoint{root_edge_[fraction < 0.5 ? 0 : 1], {u, none ? sides_[0].v_root : root_v_}};
  const auto v = v_at_station(*space_, Piece::root, u, s_, root_v_);
  const auto q = v ? space_->point(Piece::root, u, *v) : std::nullopt;
  if (!q) return {};
  return SectionPoint{q->p, {u, *v}};
}

SectionPoint ToothSection::land_point(double azimuth) const {
  const auto& chart = space_->outline().chart;
  const double h = space_->tip(s_), r = chart.r(s_, h);
  return {{r * std::cos(azimuth), r * std::sin(azimuth), chart.z(s_, h)}, {azimuth, s_}};
}

std::optional<SectionPoint> ToothSection::point(std::size_t segment, double fraction) const {
  const Side &plus = sides_[0], &minus = sides_[1];
  switch (Segment(segment)) {
    case Segment::flank_plus: return flank_point(plus, fraction);
    case Segment::fillet_plus: return fillet_point(plus, fraction);
    case Segment::root: return root_point(fraction);
    case Segment::fillet_minus: return fillet_point(minus, 1 - fraction);
    case Segment::flank_minus: return flank_point(minus, 1 - fraction);
    case Segment::land_left: {
      SectionPoint at = land_point(mid_azimuth_ + fraction * half_land_);
      if (fraction >= 1) at.p = tip_edge_[0];
      return at;
    }
    case Segment::land_right: {
      SectionPoint at = land_point(mid_azimuth_ - (1 - fraction) * half_land_ + space_->outline().pitch);
      if (fraction <= 0) at.p = tip_edge_[1];
      return at;
    }
  }
  return {};
}

}  // namespace toothpath::mesh
