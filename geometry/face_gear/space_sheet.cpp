#include "geometry/face_gear/space_sheet.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "geometry/face_gear/flank_foot.h"

namespace toothpath::face_gear {
namespace {

using Dual2 = Dual<double, 2>;

bool is_flank(SpacePiece piece) { return piece == SpacePiece::flank_plus || piece == SpacePiece::flank_minus; }
int side_of(SpacePiece piece) { return piece == SpacePiece::flank_plus || piece == SpacePiece::fillet_plus ? 1 : -1; }

PatchPoint from_dual(const Vec3T<Dual2>& p, const Vec3T<Dual2>& n) {
  return {value(p), value(n), derivative(p, 0), derivative(p, 1), derivative(n, 0), derivative(n, 1)};
}

PatchPoint turned(const PatchPoint& q, const FaceGearSurface<double>::Turn& turn) {
  return {turn(q.p), turn(q.n), turn(q.pu), turn(q.pv), turn(q.nu), turn(q.nv)};
}

}  // namespace

const char* to_string(SpacePiece piece) {
  switch (piece) {
    case SpacePiece::flank_plus: return "flank +1";
    case SpacePiece::fillet_plus: return "fillet +1";
    case SpacePiece::root: return "root";
    case SpacePiece::fillet_minus: return "fillet -1";
    case SpacePiece::flank_minus: return "flank -1";
  }
  return "";
}

SpaceSheet::SpaceSheet(const FaceGearParameters& gear, const FaceGearRing& ring)
    : ring_(ring), dual_(make_surface<Dual2>(gear, ring.zone.helix_angle_rad)), to_minus_(ring.surface.pitch) {
  if (!ring_.correction) return;
  const auto& f = ring_.surface;
  const auto section = [&](double r) { return std::sqrt(std::max(0.0, r * r - f.E * f.E)) / f.Sg; };
  const double margin = 6 * f.shaper.m_t + std::abs(f.Cg) * f.shaper.r_a;
  for (const int side : {1, -1})
    blends_[side > 0 ? 0 : 1] = std::make_shared<FilletBlend>(f, dual_, ring_.correction->side(side), side,
                                                              section(ring.zone.inner_radius_mm) - margin,
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
  return {FaceGearSurface<S>::turned(m.p, turn), FaceGearSurface<S>::turned(m.n, turn)};
}

std::optional<PatchPoint> SpaceSheet::nominal(SpacePiece piece, double u, double v) const {
  const auto& f = ring_.surface;
  const int s = side_of(piece);
  PatchPoint q;
  switch (piece) {
    case SpacePiece::flank_plus:
    case SpacePiece::flank_minus: {
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
    case SpacePiece::fillet_plus:
    case SpacePiece::fillet_minus: {
      const auto g = dual_.fillet(s, Dual2::variable(u, 0), Dual2::variable(v, 1));
      if (!g.defined) return {};
      q = from_dual(g.p, g.n);
      break;
    }
    case SpacePiece::root: {
      const auto g = root_point<Dual2>(dual_, Dual2::variable(u, 0), Dual2::variable(v, 1));
      q = from_dual(g.p, g.n);
      break;
    }
  }
  return q;
}

void SpaceSheet::displace(SpacePiece piece, double u, double v, PatchPoint& q) const {
  const int s = side_of(piece);
  double c = 0, c_u = 0, c_v = 0;
  if (is_flank(piece)) {
    const double r = std::hypot(q.p.x(), q.p.y());
    const auto offset = ring_.correction->side(s).at(u, r);
    c = offset.value;
    c_u = offset.d_theta + offset.d_radius * (q.p.x() * q.pu.x() + q.p.y() * q.pu.y()) / r;
    c_v = offset.d_radius * (q.p.x() * q.pv.x() + q.p.y() * q.pv.y()) / r;
  } else if (piece != SpacePiece::root) {
    const auto offset = blends_[s > 0 ? 0 : 1]->at(u, v);
    c = offset.value;
    c_u = offset.d_A;
    c_v = offset.d_Z;
  } else {
    return;
  }
  const Vec3 n = q.n;
  q.p += c * n;
  q.pu += c_u * n + c * q.nu;
  q.pv += c_v * n + c * q.nv;
  const Vec3 normal = q.pu.cross(q.pv);
  const double size = normal.norm();
  if (size > 0) q.n = normal * ((normal.dot(n) > 0 ? 1 : -1) / size);
}

std::optional<PatchPoint> SpaceSheet::at(SpacePiece piece, double u, double v) const {
  auto q = nominal(piece, u, v);
  if (!q || piece == SpacePiece::root) return q;
  if (ring_.correction) {
    displace(piece, u, v, *q);
    // Second derivatives of the field count where a ball hardly fits the fillet: the normals' derivatives by
    // differences of the normals.
    const double h = 1e-5, g = is_flank(piece) ? 1e-5 : 1e-3;  // rad; rad or mm
    const auto normal = [&](double a, double b) -> std::optional<Vec3> {
      auto near = nominal(piece, a, b);
      if (!near) return {};
      displace(piece, a, b, *near);
      return near->n;
    };
    const auto u0 = normal(u - h, v), u1 = normal(u + h, v), v0 = normal(u, v - g), v1 = normal(u, v + g);
    if (u0 && u1) q->nu = (*u1 - *u0) / (2 * h);
    if (v0 && v1) q->nv = (*v1 - *v0) / (2 * g);
  }
  return side_of(piece) > 0 ? q : turned(*q, to_minus_);
}

std::optional<TipPlace> SpaceSheet::tip(int side, double r, const std::optional<FlankCoordinates>& start) const {
  const auto& f = ring_.surface;
  const double z = f.z_tip(r);
  auto at = invert_flank(f, side, r, z, start);
  if (!at) return {};
  TipPlace place{*at, flank_azimuth(f, side, *at)};
  if (!ring_.correction) return place;
  const Vec3 before = f.flank(side, at->theta, at->B).p;
  const auto piece = side > 0 ? SpacePiece::flank_plus : SpacePiece::flank_minus;
  for (int k = 0; k < 20; ++k) {
    auto q = nominal(piece, place.at.theta, place.at.B);
    if (!q) return {};
    displace(piece, place.at.theta, place.at.B, *q);
    const double r_now = std::hypot(q->p.x(), q->p.y());
    const double dr = r - r_now, dz = z - q->p.z();
    if (std::abs(dr) + std::abs(dz) < 1e-11 * r) {
      place.azimuth +=
          std::atan2(before.x() * q->p.y() - before.y() * q->p.x(), before.x() * q->p.x() + before.y() * q->p.y());
      return place;
    }
    const double ru = (q->p.x() * q->pu.x() + q->p.y() * q->pu.y()) / r_now,
                 rv = (q->p.x() * q->pv.x() + q->p.y() * q->pv.y()) / r_now;
    const double zu = q->pu.z(), zv = q->pv.z(), det = ru * zv - rv * zu;
    if (det == 0) return {};
    place.at.theta += (dr * zv - dz * rv) / det;
    place.at.B += (dz * ru - dr * zu) / det;
  }
  return {};
}

std::optional<PatchPoint> SpaceSheet::point(SpacePiece piece, double u, double v) const {
  if (ring_.correction) {
    auto q = nominal(piece, u, v);
    if (!q || piece == SpacePiece::root) return q;
    displace(piece, u, v, *q);
    return side_of(piece) > 0 ? q : turned(*q, to_minus_);
  }
  const auto& f = ring_.surface;
  const int s = side_of(piece);
  SurfacePointT<double> q;
  switch (piece) {
    case SpacePiece::flank_plus:
    case SpacePiece::flank_minus: {
      const FaceGearSurface<double>::FlankPlace place(f, s, u, v);
      if (!(std::abs(v) < 1.4) || !(place.curvature().J > 0)) return {};
      q = place.point(place.turn());
      break;
    }
    case SpacePiece::fillet_plus:
    case SpacePiece::fillet_minus: {
      const auto g = f.fillet(s, u, v);
      if (!g.defined) return {};
      q = {g.p, g.n};
      break;
    }
    case SpacePiece::root: q = root_point<double>(f, u, v); break;
  }
  PatchPoint out;
  const bool turn = piece == SpacePiece::fillet_minus || piece == SpacePiece::flank_minus;
  out.p = turn ? to_minus_(q.p) : q.p;
  out.n = turn ? to_minus_(q.n) : q.n;
  return out;
}

/// By the parallel surface through the point: two unknowns, and no normal bends.
std::optional<PatchFoot> SpaceSheet::nominal_flank_foot(SpacePiece piece, const Vec3& c, double u, double v) const {
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

std::optional<PatchFoot> SpaceSheet::foot(SpacePiece piece, const Vec3& c, double u, double v) const {
  if (is_flank(piece) && !ring_.correction && std::abs(v) < 1.4)
    if (auto f = nominal_flank_foot(piece, c, u, v)) return f;
  PatchFoot f;
  f.u = u;
  f.v = v;
  double previous = INFINITY;
  for (int k = 0; k < 30; ++k) {
    const auto q = at(piece, f.u, f.v);
    if (!q) return {};
    if (k == 0) f.distance = (c - q->p).dot(q->n);
    const Vec3 residual = c - q->p - q->n * f.distance;
    const double error = residual.norm();
    f.at = *q;
    if (error < 2e-13 * (1 + c.norm()) || (error < 1e-11 && error >= 0.5 * previous)) {
      f.distance = (c - q->p).dot(q->n);
      return f;
    }
    previous = error;
    Mat3 J;
    J.col(0) = q->pu + q->nu * f.distance;
    J.col(1) = q->pv + q->nv * f.distance;
    J.col(2) = q->n;
    Vec3 step = J.inverse() * residual;
    if (!step.allFinite()) return {};
    // Roll, normal and base-tangent angles move by at most 0.15 rad, sections and distances by a fraction of a
    // millimetre scale.
    const double limit_u = piece == SpacePiece::root ? 0.5 : 0.15;
    const double limit_v = is_flank(piece) ? 0.15 : 2 * ring_.surface.shaper.m_t;
    const double shrink = std::max({1.0, std::abs(step[0]) / limit_u, std::abs(step[1]) / limit_v});
    step /= shrink;
    f.u += step[0];
    f.v += step[1];
    f.distance += step[2];
  }
  return {};
}

double SpaceSheet::normal_curvature(const PatchPoint& at, const Vec3& along) {
  const Vec3 t = along - at.n * at.n.dot(along);
  const double uu = at.pu.squaredNorm(), uv = at.pu.dot(at.pv), vv = at.pv.squaredNorm();
  const double tu = t.dot(at.pu), tv = t.dot(at.pv), det = uu * vv - uv * uv;
  const double a = (tu * vv - tv * uv) / det, b = (tv * uu - tu * uv) / det;
  return (at.nu * a + at.nv * b).dot(t) / t.squaredNorm();
}

}  // namespace toothpath::face_gear
