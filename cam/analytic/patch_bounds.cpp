#include "cam/analytic/patch_bounds.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/dual.h"

namespace toothpath::analytic {
namespace {

using First = Dual<Interval, 2>;  // value and first derivatives over a box
using Second = Dual<First, 2>;    // and second derivatives

constexpr double kUnit = 1 + 1e-14;  // covers the rounding of a few operations

/// A parameter that moves by (da, db) with the two coordinates.
Second variable(const Interval& x, double da, double db) {
  Second s;
  s.v.v = x;
  s.v.d = {Interval(da), Interval(db)};
  s.d = {First(da), First(db)};
  return s;
}

Interval square(const Interval& x) {
  const Interval s = x * x;
  return x.low >= 0 || x.high <= 0 ? s : Interval(0, s.high);
}

/// Second derivative along the direction (x, y).
Interval along(const Interval& aa, const Interval& ab, const Interval& bb, const Interval& x, const Interval& y) {
  return aa * square(x) + Interval(2) * ab * x * y + bb * square(y);
}
Interval along(const Second& f, const Interval& x, const Interval& y) {
  return along(f.d[0].d[0], f.d[0].d[1], f.d[1].d[1], x, y);
}

/// Everything about a piece over a box: place, first and second derivatives (aa, ab, bb) by the coordinates of a frame.
struct Jet {
  std::array<Interval, 3> place;
  std::array<std::array<Interval, 3>, 2> first;
  std::array<std::array<Interval, 3>, 3> second;
};

/// Nothing where a component is not finite.
std::optional<VectorBound> bound_of(const std::array<Interval, 3>& x) {
  VectorBound bound;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!x[k].finite()) return {};
    bound.middle[int(k)] = x[k].middle();
    sum += x[k].radius() * x[k].radius();
  }
  bound.spread = std::sqrt(sum) * kUnit;
  return bound;
}

}  // namespace

double PatchBend::above(const Vec3& g, double da, double db) const {
  return 0.125 * (std::max(0.0, g.dot(aa) + spread_aa) * da * da + 2 * (std::abs(g.dot(ab)) + spread_ab) * da * db +
                  std::max(0.0, g.dot(bb) + spread_bb) * db * db);
}

double PatchBend::sag(double da, double db) const {
  return 0.125 * ((aa.norm() + spread_aa) * da * da + 2 * (ab.norm() + spread_ab) * da * db +
                  (bb.norm() + spread_bb) * db * db);
}

std::optional<PatchBend> PatchBend::of(const std::array<std::array<Interval, 3>, 3>& second) {
  const auto aa = bound_of(second[0]), ab = bound_of(second[1]), bb = bound_of(second[2]);
  if (!aa || !ab || !bb) return {};
  return PatchBend{aa->middle, ab->middle, bb->middle, aa->spread, ab->spread, bb->spread};
}

struct PatchBounds::Kernels {
  face_gear::FaceGearSurface<Second> f2;
  face_gear::FaceGearSurface<First> f1;

  [[nodiscard]] Jet over(const face_gear::SpaceSheet& space, tooth_space::Piece piece, const PatchFrame& frame,
                         double half_a, double half_b) const {
    const Interval a(-half_a, half_a), b(-half_b, half_b);
    const Vec2 &o = frame.origin, &x = frame.along_a, &y = frame.along_b;
    const Second u = variable(Interval(o[0]) + a * x[0] + b * y[0], x[0], y[0]),
                 v = variable(Interval(o[1]) + a * x[1] + b * y[1], x[1], y[1]);
    const int s = side_of(piece);
    const bool moved = s != 0 && !space.field(s).none();
    if (is_fillet(piece)) {
      Jet jet = fillet(s, u, v);
      if (moved) add(jet, fillet_offset(*space.blend(s), s, u, v));
      return jet;
    }
    Vec3T<Second> p;
    if (piece == tooth_space::Piece::root) {
      const Second twist = atan2(Second(-f2.E * f2.Cg), Second(f2.Sg * v)) - f2.shaper.kappa * (v - f2.L0);
      const Second plus = -f2.i * (twist - f2.shaper.psi_c), minus = f2.pitch - f2.i * (twist + f2.shaper.psi_c);
      p = turned(f2.root_meridian(v).p, Second(plus + u * (minus - plus)));
    } else {
      p = turned(f2.flank_housing(s, u, v), Second(-f2.i * f2.flank_phi(s, u, v)));
      if (s < 0) p = turned(p, f2.pitch);
    }
    Jet jet;
    add(jet, p);
    if (moved) add(jet, flank_offset(space.field(s), s, u, v));
    return jet;
  }

  static void add(Jet& jet, const Vec3T<Second>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Second& c = p[int(k)];
      jet.place[k] += c.v.v;
      jet.first[0][k] += c.v.d[0];
      jet.first[1][k] += c.v.d[1];
      jet.second[0][k] += c.d[0].d[0];
      jet.second[1][k] += c.d[0].d[1];
      jet.second[2][k] += c.d[1].d[1];
    }
  }

  /// What a field moves a flank by, and a blend its fillet; small, so that their own levers may be long.
  [[nodiscard]] Vec3T<Second> flank_offset(const face_gear::FlankField& field, int side, const Second& theta,
                                           const Second& B) const {
    const face_gear::FaceGearSurface<Second>::FlankPlace at(f2, side, theta, B);
    const auto n = at.point(at.turn()).n;
    return placed(Vec3T<Second>(n * field.offset(f2, theta, at.housing())), side);
  }
  [[nodiscard]] Vec3T<Second> fillet_offset(const face_gear::FilletBlend& blend, int side, const Second& A,
                                            const Second& Z) const {
    return placed(Vec3T<Second>(f2.fillet(side, A, Z).n * blend.at(A, Z)), side);
  }
  [[nodiscard]] Vec3T<Second> placed(const Vec3T<Second>& v, int side) const {
    return side > 0 ? v : turned(v, f2.pitch);
  }

  /// The fillet from its first derivatives. With P the place in the housing frame, e = e(B), A the normal angle and Z
  /// the section, any move along the patch carries P by
  ///     rho e dA + (dB - s dA) (y-x rotation about the shaper axis - i k x P) + (a + i kappa k x P) dZ,
  /// which holds the small sliding speed as one factor instead of the difference of two long levers.
  [[nodiscard]] Jet fillet(int side, const Second& A, const Second& Z) const {
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
};

PatchBounds::PatchBounds(const face_gear::FaceGearParameters& gear, const face_gear::SpaceSheet& space)
    : space_(space),
      kernels_(
          std::make_unique<Kernels>(Kernels{face_gear::make_surface<Second>(gear, space.ring().zone.helix_angle_rad),
                                            face_gear::make_surface<First>(gear, space.ring().zone.helix_angle_rad)})) {
}
PatchBounds::~PatchBounds() = default;
PatchBounds::PatchBounds(PatchBounds&&) noexcept = default;

std::optional<PatchBend> PatchBounds::over(tooth_space::Piece piece, const PatchFrame& frame, double half_a,
                                           double half_b) const {
  return PatchBend::of(kernels_->over(space_, piece, frame, half_a, half_b).second);
}

std::optional<CurveBend> PatchBounds::tip_azimuth(int side, const face_gear::TipPlace& from, double r_from,
                                                  const face_gear::TipPlace& to, double r_to) const {
  const auto& f = kernels_->f2;
  const face_gear::FlankField field = space_.field(side);
  const Second z = f.z_tip(variable(Interval(r_from, r_to), 1, 0));
  const Interval z1 = z.v.d[0];
  for (const double margin : {1.0, 3.0}) {
    const double du = margin * std::abs(to.at.theta - from.at.theta) + 1e-6,
                 dv = margin * std::abs(to.at.B - from.at.B) + 1e-6;
    const Second u =
        variable({std::min(from.at.theta, to.at.theta) - du, std::max(from.at.theta, to.at.theta) + du}, 1, 0);
    const Second v = variable({std::min(from.at.B, to.at.B) - dv, std::max(from.at.B, to.at.B) + dv}, 0, 1);
    const face_gear::FaceGearSurface<Second>::FlankPlace place(f, side, u, v);
    Vec3T<Second> P = place.housing();
    if (!field.none()) {
      const TurnT<Second> still(Second(0));
      P += place.point(still).n * field.offset(f, u, P);
    }
    const Second r = sqrt(Second(P[0] * P[0] + P[1] * P[1])),
                 azimuth = atan2(P[1], P[0]) - f.i * f.flank_phi(side, u, v);
    const Interval ru = r.v.d[0], rv = r.v.d[1], zu = P[2].v.d[0], zv = P[2].v.d[1], det = ru * zv - rv * zu;
    const Interval u1 = (zv - rv * z1) / det, v1 = (ru * z1 - zu) / det;
    // Followed from its first place, the edge cannot leave the box within the step.
    if (!(u1.magnitude() * (r_to - r_from) <= du) || !(v1.magnitude() * (r_to - r_from) <= dv)) continue;
    const Interval r2 = -along(r, u1, v1), z2 = z.d[0].d[0] - along(P[2], u1, v1);
    const Interval u2 = (zv * r2 - rv * z2) / det, v2 = (ru * z2 - zu * r2) / det;
    const Interval au = azimuth.v.d[0], av = azimuth.v.d[1];
    const CurveBend out{au * u1 + av * v1, along(azimuth, u1, v1) + au * u2 + av * v2};
    if (out.slope.finite() && out.bend.finite()) return out;
  }
  return {};
}

std::optional<VectorBound> PatchBounds::bend_at_radius(tooth_space::Piece piece, const PatchFrame& frame, double half_a,
                                                       double half_b) const {
  const Jet p = kernels_->over(space_, piece, frame, half_a, half_b);
  const Interval &x = p.place[0], &y = p.place[1], r = sqrt(square(x) + square(y));
  const auto slope = [&](std::size_t n) { return (x * p.first[n][0] + y * p.first[n][1]) / r; };
  const Interval ra = slope(0), rb = slope(1), b1 = -ra / rb;
  if (!(b1.magnitude() * half_a <= half_b)) return {};  // it might leave the box
  const auto bend = [&](std::size_t n, std::size_t i, std::size_t j) {
    const Interval turn = p.first[i][0] * p.first[j][0] + p.first[i][1] * p.first[j][1] - slope(i) * slope(j);
    return (turn + x * p.second[n][0] + y * p.second[n][1]) / r;
  };
  const Interval b2 = -along(bend(0, 0, 0), bend(1, 0, 1), bend(2, 1, 1), Interval(1), b1) / rb;
  std::array<Interval, 3> second;
  for (std::size_t k = 0; k < 3; ++k)
    second[k] = along(p.second[0][k], p.second[1][k], p.second[2][k], Interval(1), b1) + p.first[1][k] * b2;
  return bound_of(second);
}

Interval PatchBounds::tip_surface_bend(double r_from, double r_to) const {
  return kernels_->f2.z_tip(variable(Interval(r_from, r_to), 1, 0)).d[0].d[0];
}

}  // namespace toothpath::analytic
