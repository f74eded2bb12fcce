#include "geometry/face_gear/space_sheet.h"

#include <algorithm>
#include <cmath>

#include "geometry/face_gear/flank_foot.h"
#include "geometry/face_gear/space_enclosures.h"
#include "geometry/tooth_space/exact_space.h"

namespace toothpath::face_gear {
namespace {

using Dual2 = Dual<double, 2>;

using tooth_space::Piece;

constexpr int kNewtonSteps = 20;
constexpr double kDisplacedJoin = 3e-5;

PatchPoint from_dual(const Vec3T<Dual2>& p, const Vec3T<Dual2>& n) {
  return {value(p), value(n), derivative(p, 0), derivative(p, 1), derivative(n, 0), derivative(n, 1)};
}

std::optional<FlankCoordinates> start_of(const std::optional<EdgePlace>& near) {
  return near ? std::optional(FlankCoordinates{near->u, near->v}) : std::nullopt;
}

/// Radius of a point, and how fast it changes with the two parameters.
struct Radius {
  double r, u, v;
  explicit Radius(const PatchPoint& q)
      : r(std::hypot(q.p.x(), q.p.y())),
        u((q.p.x() * q.pu.x() + q.p.y() * q.pu.y()) / r),
        v((q.p.x() * q.pv.x() + q.p.y() * q.pv.y()) / r) {}
};

PatchPoint placed(const PatchPoint& q, const Turn& turn) {
  return {turn(q.p), turn(q.n), turn(q.pu), turn(q.pv), turn(q.nu), turn(q.nv)};
}

}  // namespace

SpaceSheet::SpaceSheet(const FaceGearParameters& gear, const FaceGearRing& ring)
    : ring_(ring),
      active_end_(active_roll_parameter(gear, ring.zone.helix_angle_rad)),
      dual_(make_surface<Dual2>(gear, ring.zone.helix_angle_rad)),
      second_(make_surface<Second>(gear, ring.zone.helix_angle_rad)),
      to_minus_(ring.surface.pitch),
      enclosures_(std::make_shared<SpaceEnclosures>(gear, ring.zone.helix_angle_rad)) {
  outline_.pitch = ring.surface.pitch;
  outline_.s_from = ring.zone.inner_radius_mm;
  outline_.s_to = ring.zone.outer_radius_mm;
  outline_.pitch_normal = -ring.surface.d();
  // Corrected pieces share their normals to 1e-5 only; a foot so little beyond is about 1e-6 mm wrong.
  if (ring_.displaced()) outline_.join = kDisplacedJoin;
  if (!ring_.displaced()) return;
  const auto& f = ring_.surface;
  const auto section = [&](double r) { return std::sqrt(std::max(0.0, r * r - f.E * f.E)) / f.Sg; };
  const double margin = 6 * f.shaper.m_t + std::abs(f.Cg) * f.shaper.r_a;
  for (const int side : {1, -1})
    blends_[side > 0 ? 0 : 1] =
        std::make_shared<FilletBlend>(f, dual_, field(side), side, section(ring.zone.inner_radius_mm) - margin,
                                      section(ring.zone.outer_radius_mm) + margin);
}

template <typename S>
SurfacePointT<S> SpaceSheet::root_point(const FaceGearSurface<S>& f, const S& fraction, const S& Z) const {
  using std::atan2;
  const S b0 = atan2(S(-f.E * f.Cg), S(f.Sg * Z));
  const S twist = b0 - f.shaper.kappa * (Z - f.L0);
  const S turn_plus = -f.i * (twist - f.shaper.psi_c), turn_minus = f.pitch - f.i * (twist + f.shaper.psi_c);
  const S turn = turn_plus + fraction * (turn_minus - turn_plus);
  const auto m = f.root_meridian(Z);
  return {turned(m.p, turn), turned(m.n, turn)};
}

std::optional<PatchPoint> SpaceSheet::plain(tooth_space::Piece piece, double u, double v) const {
  const auto& f = ring_.surface;
  const int s = side_of(piece);
  PatchPoint q;
  switch (piece) {
    case Piece::flank_plus:
    case Piece::flank_minus: {
      if (!(std::abs(v) < 1.4)) return {};
      const FaceGearSurface<double>::FlankPlace place(f, s, u, v);
      const auto k = place.curvature();
      if (!(k.J > 0)) return {};
      const auto H = place.shape(k);
      const auto turn = place.turn();
      const auto point = place.point(turn);
      const auto d = place.derivatives(point, turn);
      const auto basis = place.basis(turn);
      const auto dn = [&](const Vec3& along) {
        const double x = along.dot(basis.e), y = along.dot(basis.l);
        return Vec3(basis.e * (H.ee * x + H.el * y) + basis.l * (H.el * x + H.ll * y));
      };
      q = {point.p, point.n, d.u, d.v, dn(d.u), dn(d.v)};
      break;
    }
    case Piece::fillet_plus:
    case Piece::fillet_minus: {
      const auto g = dual_.fillet(s, Dual2::variable(u, 0), Dual2::variable(v, 1));
      if (!g.defined) return {};
      q = from_dual(g.p, g.n);
      break;
    }
    case Piece::root: {
      const auto g = root_point<Dual2>(dual_, Dual2::variable(u, 0), Dual2::variable(v, 1));
      q = from_dual(g.p, g.n);
      break;
    }
    default: return {};
  }
  return q;
}

FlankField SpaceSheet::field(int side) const {
  FlankField out;
  if (ring_.modification && !ring_.modification->side(side).empty()) out.drawn = &ring_.modification->side(side);
  if (ring_.correction) out.measured = &ring_.correction->side(side);
  return out;
}

template <typename S>
std::optional<SurfacePointT<S>> SpaceSheet::moved(const FaceGearSurface<S>& f, Piece piece, const S& u,
                                                  const S& v) const {
  const int s = side_of(piece);
  if (is_flank(piece)) {
    const auto at = f.flank(s, u, v);
    return SurfacePointT<S>{at.p + at.n * field(s).offset(f, u, at.p), at.n};
  }
  const auto at = f.fillet(s, u, v);
  if (!at.defined) return {};
  return SurfacePointT<S>{at.p + at.n * blend(s)->at(u, v), at.n};
}

std::optional<PatchPoint> SpaceSheet::displaced(Piece piece, double u, double v, bool curved) const {
  if (is_flank(piece) && (!(std::abs(v) < 1.4) || !(ring_.surface.flank_J(side_of(piece), u, v) > 0))) return {};
  if (!curved) {
    PatchPoint q;
    const auto at = moved<Dual2>(dual_, piece, Dual2::variable(u, 0), Dual2::variable(v, 1));
    if (!at) return {};
    q.p = value(at->p);
    q.pu = derivative(at->p, 0);
    q.pv = derivative(at->p, 1);
    const Vec3 n = q.pu.cross(q.pv), plain = value(at->n);
    const double size = n.norm();
    q.n = size > 0 ? Vec3(n * ((n.dot(plain) > 0 ? 1 : -1) / size)) : plain;
    return q;
  }
  const auto at = moved<Second>(second_, piece, tooth_space::second_variable(u, 0), tooth_space::second_variable(v, 1));
  if (!at) return {};
  return tooth_space::patch_of(at->p, Vec3(at->n[0].v.v, at->n[1].v.v, at->n[2].v.v));
}

std::optional<PatchPoint> SpaceSheet::at(Piece piece, double u, double v) const {
  const bool plain_here = !ring_.displaced() || piece == Piece::root;
  const auto q = plain_here ? plain(piece, u, v) : displaced(piece, u, v, true);
  if (!q || piece == Piece::root) return q;
  return side_of(piece) > 0 ? q : placed(*q, to_minus_);
}

std::optional<FlankCoordinates> SpaceSheet::invert(int side, double r, double z,
                                                   const std::optional<FlankCoordinates>& start) const {
  const auto& f = ring_.surface;
  auto at = invert_flank(f, side, r, z, start);
  if (!at || field(side).none()) return at;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto q = displaced(tooth_space::flank_of(side), at->theta, at->B, false);
    if (!q) return {};
    const Radius now(*q);
    const double dr = r - now.r, dz = z - q->p.z();
    if (std::abs(dr) + std::abs(dz) < 1e-11 * r) {
      at->J = f.flank_J(side, at->theta, at->B);
      return at;
    }
    const double zu = q->pu.z(), zv = q->pv.z(), det = now.u * zv - now.v * zu;
    if (det == 0) return {};
    at->theta += (dr * zv - dz * now.v) / det;
    at->B += (dz * now.u - dr * zu) / det;
  }
  return {};
}

tooth_space::Borders SpaceSheet::borders(Piece piece) const {
  const auto& w = ring_.surface.shaper;
  const tooth_space::WallBorders wall{-INFINITY, w.theta_t, w.A_t, w.A_e};
  return borders_of(piece, wall, wall);
}

tooth_space::Borders SpaceSheet::active(Piece flank) const {
  return flank == Piece::flank_plus ? tooth_space::Borders{-INFINITY, active_end_}
                                    : tooth_space::Borders{active_end_, -INFINITY};
}

std::optional<EdgePlace> SpaceSheet::plain_tip_edge(int side, double r, const std::optional<EdgePlace>& near) const {
  const auto& f = ring_.surface;
  const auto at = invert_flank(f, side, r, f.z_tip(r), start_of(near));
  if (!at) return {};
  return EdgePlace{at->theta, at->B, flank_azimuth(f, side, *at)};
}

std::optional<EdgePlace> SpaceSheet::tip_edge(int side, double r, const std::optional<EdgePlace>& near) const {
  if (field(side).none()) return plain_tip_edge(side, r, near);
  const auto& f = ring_.surface;
  const auto at = invert(side, r, f.z_tip(r), start_of(near));
  if (!at) return {};
  EdgePlace place{at->theta, at->B, flank_azimuth(f, side, *at)};
  // flank_azimuth follows the plain flank without a jump; the displaced point lies a little beside it.
  place.azimuth += angle_from_to(f.flank(side, at->theta, at->B).p, flank(side, at->theta, at->B).p);
  return place;
}

std::optional<double> SpaceSheet::start_v(Piece piece, double u, double r, double distance,
                                          const std::optional<tooth_space::Near>& near, int attempt) const {
  const auto& f = ring_.surface;
  const int side = side_of(piece);
  if (is_flank(piece)) {
    if (attempt > 0) return {};
    // The ball-centre surface of a flank is the flank itself, turned, at theta - distance cos(beta_b)/r_b.
    const double theta = u - distance * f.shaper.cos_bb / f.shaper.r_b;
    return flank_B_at_radius(f, side, theta, r, near ? near->v : regular_start_B(f, side, theta));
  }
  // Edge by edge in one section; where Newton starts from nothing, from the edge's own place at this radius.
  const double plane = (std::sqrt(std::max(0.0, r * r - f.E * f.E)) + f.shaper.r_a * f.Cg) / f.Sg;
  const auto next = near ? std::optional(near->v + (r - near->s)) : std::nullopt;
  if (attempt == 0) return next;
  if (attempt == 1 && piece != Piece::root) return fillet_Z_at_radius(f, side, u, r, next.value_or(plane));
  return attempt == 2 ? std::optional(plane) : std::nullopt;
}

double SpaceSheet::longest_step(Piece piece, double r) const { return is_flank(piece) ? 0.1 : 0.1 * r; }

tooth_space::CurveBend SpaceSheet::tip_bend(double r_from, double r_to) const { return enclosures_->tip(r_from, r_to); }
std::optional<tooth_space::Jet> SpaceSheet::enclosure(Piece piece, const tooth_space::PatchFrame& frame, double half_a,
                                                      double half_b) const {
  return enclosures_->over(*this, piece, {frame, half_a, half_b});
}
std::optional<tooth_space::CurveBend> SpaceSheet::tip_azimuth(int side, const EdgePlace& from, double r_from,
                                                              const EdgePlace& to, double r_to) const {
  return enclosures_->tip_azimuth(field(side), side, from, r_from, to, r_to);
}

SurfacePointT<double> SpaceSheet::flank(int side, double theta, double B) const {
  if (!field(side).none())
    if (const auto q = displaced(tooth_space::flank_of(side), theta, B, false)) return {q->p, q->n};
  return ring_.surface.flank(side, theta, B);
}

Vec3 SpaceSheet::fillet(int side, double A, double Z) const {
  const auto at = ring_.surface.fillet(side, A, Z);
  return field(side).none() ? at.p : Vec3(at.p + at.n * blend(side)->at(A, Z));
}

std::optional<double> SpaceSheet::v_at_radius(Piece piece, double u, double r, double v) const {
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto q = displaced(piece, u, v, false);
    if (!q) return {};
    const Radius now(*q);
    if (std::abs(r - now.r) < 1e-11 * r) return v;
    if (now.v == 0) return {};
    v += (r - now.r) / now.v;
  }
  return {};
}

std::optional<double> SpaceSheet::B_at_radius(int side, double theta, double r, double start_B) const {
  const auto B = flank_B_at_radius(ring_.surface, side, theta, r, start_B);
  return !B || field(side).none() ? B : v_at_radius(tooth_space::flank_of(side), theta, r, *B);
}

std::optional<PatchPoint> SpaceSheet::point(Piece piece, double u, double v) const {
  if (ring_.displaced()) {
    const auto q = piece == Piece::root ? plain(piece, u, v) : displaced(piece, u, v, false);
    if (!q || piece == Piece::root) return q;
    return side_of(piece) > 0 ? q : placed(*q, to_minus_);
  }
  const auto& f = ring_.surface;
  const int s = side_of(piece);
  SurfacePointT<double> q;
  switch (piece) {
    case Piece::flank_plus:
    case Piece::flank_minus: {
      const FaceGearSurface<double>::FlankPlace place(f, s, u, v);
      if (!(std::abs(v) < 1.4) || !(place.curvature().J > 0)) return {};
      q = place.point(place.turn());
      break;
    }
    case Piece::fillet_plus:
    case Piece::fillet_minus: {
      const auto g = f.fillet(s, u, v);
      if (!g.defined) return {};
      q = {g.p, g.n};
      break;
    }
    case Piece::root: q = root_point<double>(f, u, v); break;
    default: return {};
  }
  PatchPoint out;
  const bool turn = piece == Piece::fillet_minus || piece == Piece::flank_minus;
  out.p = turn ? to_minus_(q.p) : q.p;
  out.n = turn ? to_minus_(q.n) : q.n;
  return out;
}

/// By the parallel surface through the point: two unknowns, and no normal bends.
std::optional<PatchFoot> SpaceSheet::nominal_flank_foot(Piece piece, const Vec3& c, double u, double v) const {
  const auto& f = ring_.surface;
  const int side = side_of(piece);
  const Vec3 x = side > 0 ? c : to_minus_.back(c);
  const FaceGearSurface<double>::FlankPlace near(f, side, u, v);
  const auto seen = near.point(near.turn());
  const auto foot = flank_foot<double>(f, side, x, {theta_at_distance<double>(f, u, (x - seen.p).dot(seen.n)), v});
  if (!foot) return {};
  const auto q = at(piece, foot->theta_foot, foot->at.B);
  if (!q) return {};
  return PatchFoot{foot->theta_foot, foot->at.B, foot->d, *q};
}

std::optional<PatchFoot> SpaceSheet::foot(Piece piece, const Vec3& c, double u, double v) const {
  if (is_flank(piece) && !ring_.displaced() && std::abs(v) < 1.4)
    if (auto f = nominal_flank_foot(piece, c, u, v)) return f;
  // Roll, normal and base-tangent angles move by at most 0.15 rad, sections and distances by a fraction of a millimetre
  // scale.
  const Vec2 most(piece == Piece::root ? 0.5 : 0.15, is_flank(piece) ? 0.15 : 2 * ring_.surface.shaper.m_t);
  return tooth_space::search_foot(*this, piece, c, u, v, most);
}

std::optional<PatchFoot> SpaceSheet::next_foot(Piece piece, const Vec3& c, const PatchFoot& near) const {
  if (!is_flank(piece)) return ToothSpace::next_foot(piece, c, near);
  const int side = side_of(piece);
  const auto foot = flank_foot<double>(ring_.surface, side, side > 0 ? c : to_minus_.back(c),
                                       {theta_at_distance<double>(ring_.surface, near.u, near.distance), near.v});
  if (!foot) return {};
  PatchFoot f{foot->theta_foot, foot->at.B, foot->d, {}};
  // A displaced flank lies hundredths of a millimetre away.
  if (ring_.displaced()) return ToothSpace::next_foot(piece, c, f);
  f.at.n = side > 0 ? foot->n : to_minus_(foot->n);
  f.at.p = c - f.distance * f.at.n;
  return f;
}

}  // namespace toothpath::face_gear
