#include "geometry/face_gear/space_enclosures.h"

#include <algorithm>
#include <cmath>

#include "geometry/face_gear/space_sheet.h"

namespace toothpath::face_gear {

using tooth_space::Jet;
using tooth_space::Piece;

SpaceEnclosures::SpaceEnclosures(const FaceGearParameters& gear, double helix_angle_rad)
    : f2(make_surface<Second>(gear, helix_angle_rad)), f1(make_surface<First>(gear, helix_angle_rad)) {}

Jet SpaceEnclosures::over(const SpaceSheet& space, Piece piece, const tooth_space::BoxParameters& box) const {
  const auto& [u, v] = box;
  const int s = side_of(piece);
  const bool moved = s != 0 && !space.field(s).none();
  if (is_fillet(piece)) {
    Jet jet = fillet(s, u, v);
    if (moved) jet.add(fillet_offset(*space.blend(s), s, u, v));
    return jet;
  }
  Jet jet;
  if (is_flank(piece)) {
    jet.add(placed(turned(f2.flank_housing(s, u, v), Second(-f2.i * f2.flank_phi(s, u, v))), s));
    if (moved) jet.add(flank_offset(space.field(s), s, u, v));
    return jet;
  }
  const Second twist = atan2(Second(-f2.E * f2.Cg), Second(f2.Sg * v)) - f2.shaper.kappa * (v - f2.L0);
  const Second plus = -f2.i * (twist - f2.shaper.psi_c), minus = f2.pitch - f2.i * (twist + f2.shaper.psi_c);
  jet.add(turned(f2.root_meridian(v).p, Second(plus + u * (minus - plus))));
  return jet;
}

/// What a field moves a flank by, and a blend its fillet; small, so that their own levers may be long.
Vec3T<SpaceEnclosures::Second> SpaceEnclosures::flank_offset(const FlankField& field, int side, const Second& theta,
                                                             const Second& B) const {
  const FaceGearSurface<Second>::FlankPlace at(f2, side, theta, B);
  const auto n = at.point(at.turn()).n;
  return placed(Vec3T<Second>(n * field.offset(f2, theta, at.housing())), side);
}
Vec3T<SpaceEnclosures::Second> SpaceEnclosures::fillet_offset(const FilletBlend& blend, int side, const Second& A,
                                                              const Second& Z) const {
  return placed(Vec3T<Second>(f2.fillet(side, A, Z).n * blend.at(A, Z)), side);
}
Vec3T<SpaceEnclosures::Second> SpaceEnclosures::placed(const Vec3T<Second>& v, int side) const {
  return side > 0 ? v : turned(v, f2.pitch);
}

/// The fillet from its first derivatives. With P the place in the housing frame, e = e(B), A the normal angle and Z the
/// section, any move along the patch carries P by
///     rho e dA + (dB - s dA) (y-x rotation about the shaper axis - i k x P) + (a + i kappa k x P) dZ,
/// which holds the small sliding speed as one factor instead of the difference of two long levers.
Jet SpaceEnclosures::fillet(int side, const Second& A, const Second& Z) const {
  const auto& w = f2.shaper;
  const Second s(side), h = w.rounding_h(A), g = w.rounding_g(A);
  const Second C = f2.Sg * (Z - s * w.kappa * g * h), Sn = h * h * w.kappa * f2.Sg - f2.E * f2.Cg;
  const Second D_h = h * (Second(1) / f2.i + f2.Cg) - h * w.kappa * f2.E * f2.Sg;
  const Second angle = atan2(Sn, C) + s * acos(Second(D_h / sqrt(Second(Sn * Sn + C * C))));
  const First B = angle.v, sB = sin(B), cB = cos(B), t(side), Z1 = Z.v;
  const First x = h.v * cB + t * g.v * sB, y = h.v * sB - t * g.v * cB;
  const Vec3T<First> P(First(Z1 * f1.Sg - x * f1.Cg), First(f1.E + y), First(-Z1 * f1.Cg - x * f1.Sg)),
      kP(First(-P[1]), P[0], First(0));
  const Vec3T<First> sliding = f1.b() * x - f1.d() * y - kP * f1.i,
                     section = f1.a() + kP * First(f1.i * f1.shaper.kappa);
  const Vec3T<First> rounding = f1.e(B) * f1.shaper.rho;
  First turn = -f1.i * (B - t * A.v - f1.shaper.kappa * (Z1 - f1.L0));
  if (side < 0) turn += f1.pitch;
  Jet jet;
  const Vec3T<First> place = turned(P, turn);
  for (std::size_t k = 0; k < 3; ++k) jet.place[k] = place[int(k)].v;
  for (std::size_t n = 0; n < 2; ++n) {
    const First dB = angle.d[n] - t * A.d[n];
    const Vec3T<First> d = turned(Vec3T<First>(rounding * A.d[n] + sliding * dB + section * Z.d[n]), turn);
    for (std::size_t k = 0; k < 3; ++k) {
      jet.first[n][k] = d[int(k)].v;
      jet.second[n][k] = d[int(k)].d[0];
      jet.second[n + 1][k] = d[int(k)].d[1];
    }
  }
  return jet;
}

/// Of z_tip, differentiated by hand: it is asked for at every piece of the surface that a body comes near.
tooth_space::CurveBend SpaceEnclosures::tip(double r_from, double r_to) const {
  const Interval r(r_from, r_to), E = f1.E.v, tilt = f1.Cg.v / f1.Sg.v, run = sqrt(r * r - E * E);
  return {-tilt * r / run, tilt * E * E / (run * run * run)};
}

std::optional<tooth_space::CurveBend> SpaceEnclosures::tip_azimuth(const FlankField& field, int side,
                                                                   const tooth_space::EdgePlace& from, double r_from,
                                                                   const tooth_space::EdgePlace& to,
                                                                   double r_to) const {
  const Second z = f2.z_tip(tooth_space::box_variable(Interval(r_from, r_to), 1, 0));
  const Interval z1 = z.v.d[0];
  for (const double margin : {1.0, 3.0}) {
    const double du = margin * std::abs(to.u - from.u) + 1e-6, dv = margin * std::abs(to.v - from.v) + 1e-6;
    const Second u = tooth_space::box_variable({std::min(from.u, to.u) - du, std::max(from.u, to.u) + du}, 1, 0);
    const Second v = tooth_space::box_variable({std::min(from.v, to.v) - dv, std::max(from.v, to.v) + dv}, 0, 1);
    const FaceGearSurface<Second>::FlankPlace place(f2, side, u, v);
    Vec3T<Second> P = place.housing();
    if (!field.none()) {
      const TurnT<Second> still(Second(0));
      P += place.point(still).n * field.offset(f2, u, P);
    }
    const Second r = sqrt(Second(P[0] * P[0] + P[1] * P[1])),
                 azimuth = atan2(P[1], P[0]) - f2.i * f2.flank_phi(side, u, v);
    const Interval ru = r.v.d[0], rv = r.v.d[1], zu = P[2].v.d[0], zv = P[2].v.d[1], det = ru * zv - rv * zu;
    const Interval u1 = (zv - rv * z1) / det, v1 = (ru * z1 - zu) / det;
    // Followed from its first place, the edge cannot leave the box within the step.
    if (!(u1.magnitude() * (r_to - r_from) <= du) || !(v1.magnitude() * (r_to - r_from) <= dv)) continue;
    const Interval r2 = -tooth_space::along(r, u1, v1), z2 = z.d[0].d[0] - tooth_space::along(P[2], u1, v1);
    const Interval u2 = (zv * r2 - rv * z2) / det, v2 = (ru * z2 - zu * r2) / det;
    const Interval au = azimuth.v.d[0], av = azimuth.v.d[1];
    const tooth_space::CurveBend out{au * u1 + av * v1, tooth_space::along(azimuth, u1, v1) + au * u2 + av * v2};
    if (out.slope.finite() && out.bend.finite()) return out;
  }
  return {};
}

}  // namespace toothpath::face_gear
