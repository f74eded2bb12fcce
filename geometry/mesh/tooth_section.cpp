#include "geometry/mesh/tooth_section.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::mesh {
namespace {

using tooth_space::Borders;
using tooth_space::ToothSpace;

/// Angles below this many mm of arc are rounding, not a crossing.
constexpr double kArcNoise_mm = 1e-9;
/// A fillet that misses the end of its flank by more than this is on another sheet.
constexpr double kJoin_mm = 1e-7;
constexpr double kOnStation = 1e-13;  // of the size of a place

double mixed(double a, double b, double t) { return a + t * (b - a); }

struct Solved {
  double v = 0;
  Vec3 p = Vec3::Zero();
};

/// The place of a piece at this u and station s, from a start and the station's slope by v there. Nothing where it is
/// not found.
std::optional<Solved> at_station(const ToothSpace& space, Piece piece, double u, double s, double start, double slope) {
  constexpr int kMostSteps = 40, kMostHalves = 5;  // a step may leave what the piece is defined on
  const auto& ring = space.outline();
  const double longest = space.longest_step(piece, s);
  const auto first = space.point(piece, u, start);
  if (!first) return {};
  Solved best{start, first->p};
  const double enough = kOnStation * best.p.norm();
  double lack = s - ring.station(best.p);
  for (int k = 0; k < kMostSteps; ++k) {
    if (std::abs(lack) <= enough) return best;
    double step = std::clamp(lack / slope, -longest, longest);
    if (!std::isfinite(step)) return {};
    auto next = space.point(piece, u, best.v + step);
    for (int half = 0; half < kMostHalves && !next; ++half) next = space.point(piece, u, best.v + (step *= 0.5));
    if (!next) return {};
    const double left = s - ring.station(next->p);
    // Rounding: nothing nearer is found.
    if (std::abs(left) >= 0.5 * std::abs(lack) && std::abs(lack) <= 100 * enough) return best;
    if (std::abs(left) > 100 * enough) slope = (lack - left) / step;
    best = {best.v + step, next->p};
    lack = left;
  }
  return {};
}

/// A solved place with the slopes of its line at station s.
std::optional<SectionLine::Node> node_of(const ToothSpace& space, Piece piece, double u, double v) {
  const auto q = space.at(piece, u, v);
  if (!q) return {};
  const auto& ring = space.outline();
  const double sv = ring.station(q->p, q->pv), dv = -ring.station(q->p, q->pu) / sv;
  if (!std::isfinite(dv)) return {};
  return SectionLine::Node{v, dv, sv};
}

/// From a node to the u that lies `step` beyond, at station s; where that start is too far off, in halves of the way:
/// beside an undercut v runs quickly along a fillet. `bend`: how much dv grows on the way.
std::optional<SectionLine::Node> next_node(const ToothSpace& space, Piece piece, double s, double u, double step,
                                           const SectionLine::Node& from, double bend, int halvings = 6) {
  if (const auto solved = at_station(space, piece, u, s, from.v + step * (from.dv + 0.5 * bend), from.sv))
    if (const auto node = node_of(space, piece, u, solved->v)) return node;
  if (halvings == 0) return {};
  const double half_step = 0.5 * step;
  const auto half = next_node(space, piece, s, u - half_step, half_step, from, 0.5 * bend, halvings - 1);
  return half ? next_node(space, piece, s, u, half_step, *half, half->dv - from.dv, halvings - 1) : std::nullopt;
}

/// The line of a piece at station s from a solved place.
std::optional<SectionLine> followed(const ToothSpace& space, Piece piece, double s, double u_from, double v_from,
                                    double u_to) {
  SectionLine line{u_from, u_to, {}};
  const double step = (u_to - u_from) / SectionLine::kSteps;
  for (std::size_t k = 0; k < line.nodes.size(); ++k) {
    const double u = line.u(double(k) / SectionLine::kSteps),
                 bend = k > 1 ? line.nodes[k - 1].dv - line.nodes[k - 2].dv : 0;
    const auto node =
        k == 0 ? node_of(space, piece, u, v_from) : next_node(space, piece, s, u, step, line.nodes[k - 1], bend);
    if (!node) return {};
    line.nodes[k] = *node;
  }
  return line;
}

/// v of a piece at station s where no place of it is known; the first solved one that `fits` counts.
template <typename Fits>
std::optional<double> first_v(const ToothSpace& space, Piece piece, double u, double s,
                              const std::optional<tooth_space::Near>& near, const Fits& fits) {
  for (int attempt = 0; attempt < ToothSpace::kStarts; ++attempt) {
    const auto start = space.start_v(piece, u, s, 0, near, attempt);
    if (!start) continue;
    const auto q = space.at(piece, u, *start);
    if (!q) continue;
    const auto solved = at_station(space, piece, u, s, *start, space.outline().station(q->p, q->pv));
    if (solved && fits(solved->p)) return solved->v;
  }
  return {};
}

}  // namespace

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
  const double s_tip = space.tip_s(s);
  const auto tip = space.tip_edge(side, s_tip, before ? std::optional(before->tip) : std::nullopt);
  const auto where = [&] { return tooth_space::station(space.outline(), s); };
  if (!tip)
    return fail("flank {:+d} does not reach the tip surface at {} (height {:.4f} mm)", side, where(), space.tip(s_tip));
  const Piece flank = tooth_space::flank_of(side), fillet = tooth_space::fillet_of(side);
  const Borders of_flank = space.borders(flank), of_fillet = space.borders(fillet);
  const double u_end = side > 0 ? of_flank.to : of_flank.from, u_join = side > 0 ? of_fillet.from : of_fillet.to,
               u_root = side > 0 ? of_fillet.to : of_fillet.from;
  // On its tip's side a flank has no border.
  const bool grows = (side > 0 ? of_flank.from : of_flank.to) < 0;
  if (grows ? tip->u >= u_end : tip->u <= u_end)
    return fail("flank {:+d} has no involute at {}: its fillet reaches the tip surface", side, where());
  const auto along_flank = followed(space, flank, s, tip->u, tip->v, u_end);
  const auto end = along_flank ? space.point(flank, u_end, along_flank->nodes.back().v) : std::nullopt;
  if (!end) return fail("flank {:+d} does not reach its fillet at {}: undercut", side, where());
  std::optional<tooth_space::Near> joined;
  if (before) joined = tooth_space::Near{before->fillet.nodes.front().v, near->s_};
  const auto fits = [&](const Vec3& p) { return (p - end->p).norm() <= kJoin_mm; };
  auto v_join = first_v(space, fillet, u_join, s, joined, fits);
  if (!v_join)  // v may run quickly up a fillet
    if (const auto v = tooth_space::v_at(space, fillet, u_join, s))
      if (const auto q = space.at(fillet, u_join, *v); q && fits(q->p)) v_join = v;
  if (!v_join) return fail("fillet {:+d} does not join its flank at {}: undercut", side, where());
  const auto along_fillet = followed(space, fillet, s, u_join, *v_join, u_root);
  if (!along_fillet) return fail("fillet {:+d} does not reach the root at {}", side, where());
  return Side{side, *tip, *along_flank, *along_fillet};
}

Result<ToothSection> ToothSection::at(const ToothSpace& space, double s, const ToothSection* near) {
  ToothSection section;
  section.space_ = &space;
  section.s_ = s;
  section.s_tip_ = space.tip_s(s);
  for (std::size_t k = 0; k < 2; ++k) {
    const int sign = k == 0 ? 1 : -1;
    const auto side = make_side(space, sign, s, near);
    if (!side) return side.error();
    section.sides_[k] = *side;
    section.tip_edge_[k] = space.point(tooth_space::flank_of(sign), side->tip.u, side->tip.v)->p;
    section.root_edge_[k] =
        space.point(tooth_space::fillet_of(sign), side->fillet.u_to, side->fillet.nodes.back().v)->p;
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
        first_v(space, Piece::root, mixed(of_root.from, of_root.to, 0.5), s, before, [](const Vec3&) { return true; });
    if (!v) return fail("the root is not defined at {}", section.station());
    section.root_v_ = *v;
    const auto q = space.at(Piece::root, mixed(of_root.from, of_root.to, 0.5), *v);
    section.root_sv_ = space.outline().station(q->p, q->pv);
  }
  return section;
}

/// From the cubic between two nodes.
std::optional<SectionPoint> ToothSection::on_line(Piece piece, const SectionLine& line, double share) const {
  const double at = share * SectionLine::kSteps, u = line.u(share);
  const auto k = std::size_t(std::clamp(int(at), 0, SectionLine::kSteps - 1));
  const auto &a = line.nodes[k], &b = line.nodes[k + 1];
  const double t = at - double(k), w = 1 - t, step = (line.u_to - line.u_from) / SectionLine::kSteps;
  const double start = w * w * (1 + 2 * t) * a.v + t * t * (1 + 2 * w) * b.v + step * t * w * (w * a.dv - t * b.dv);
  if (const auto solved = at_station(*space_, piece, u, s_, start, mixed(a.sv, b.sv, t)))
    return SectionPoint{solved->p, {u, solved->v}};
  const auto node = next_node(*space_, piece, s_, u, t * step, a, t * (b.dv - a.dv));
  const auto q = node ? space_->point(piece, u, node->v) : std::nullopt;
  return q ? std::optional(SectionPoint{q->p, {u, node->v}}) : std::nullopt;
}

std::optional<SectionPoint> ToothSection::flank_point(const Side& side, double from_tip) const {
  if (from_tip <= 0) return SectionPoint{tip_edge_[side.s > 0 ? 0 : 1], {side.tip.u, side.tip.v}};
  return on_line(tooth_space::flank_of(side.s), side.flank, from_tip);
}

std::optional<SectionPoint> ToothSection::flank_at(int side, double u) const {
  const Side& of = sides_[side > 0 ? 0 : 1];
  return flank_point(of, (u - of.flank.u_from) / (of.flank.u_to - of.flank.u_from));
}

std::optional<SectionPoint> ToothSection::fillet_point(const Side& side, double from_flank) const {
  if (from_flank <= 0) {  // the flank's own bits
    const auto end = flank_point(side, 1);
    if (!end) return {};
    return SectionPoint{end->p, {side.fillet.u_from, side.fillet.nodes.front().v}};
  }
  if (from_flank >= 1)
    return SectionPoint{root_edge_[side.s > 0 ? 0 : 1], {side.fillet.u_to, side.fillet.nodes.back().v}};
  return on_line(tooth_space::fillet_of(side.s), side.fillet, from_flank);
}

std::optional<SectionPoint> ToothSection::root_point(double fraction) const {
  const Borders of_root = space_->borders(Piece::root);
  const double u = mixed(of_root.from, of_root.to, fraction);
  const bool none = root_width_ * radius(root_edge_[0]) <= kArcNoise_mm;
  if (none || fraction <= 0 || fraction >= 1)
    return SectionPoint{root_edge_[fraction < 0.5 ? 0 : 1], {u, none ? sides_[0].fillet.nodes.back().v : root_v_}};
  const auto solved = at_station(*space_, Piece::root, u, s_, root_v_, root_sv_);
  if (!solved) return {};
  return SectionPoint{solved->p, {u, solved->v}};
}

SectionPoint ToothSection::land_point(double azimuth) const {
  const auto& chart = space_->outline().chart;
  const double h = space_->tip(s_tip_), r = chart.r(s_tip_, h);
  return {{r * std::cos(azimuth), r * std::sin(azimuth), chart.z(s_tip_, h)}, {azimuth, s_tip_}};
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
