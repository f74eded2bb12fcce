#include "geometry/face_gear/inverse.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>

#include "geometry/base/angle.h"

namespace toothpath::face_gear {
namespace {

constexpr int kNewtonLimit = 60;

struct Meridian {
  double r = 0, z = 0;
};

Meridian meridian(const FaceGearSurface<double>& f, int s, double theta, double B) {
  const Vec3 P = f.flank_housing(s, theta, B);
  return {std::hypot(P.x(), P.y()), P.z()};
}

/// Newton for (theta, B) at (r, z) with short steps; false if it does not arrive.
bool newton(const FaceGearSurface<double>& f, int s, double r, double z, double& theta, double& B, int& iterations) {
  const double goal = 4e-16 * std::max(r, 1.0);
  double best = INFINITY;
  int stalled = 0;
  for (int k = 0; k < kNewtonLimit; ++k, ++iterations) {
    const FaceGearSurface<double>::FlankPlace at(f, s, theta, B);
    const Vec3 P = at.housing();
    const double r_now = std::hypot(P.x(), P.y());
    const double er = r - r_now, ez = z - P.z(), error = std::hypot(er, ez);
    if (!(error < INFINITY)) return false;
    if (error <= goal) return true;
    if (error >= 0.5 * best) {
      if (++stalled > 3 && best < 1e-13 * std::max(r, 1.0)) return true;  // at the floor of rounding
      if (stalled > 12) return false;
    }
    best = std::min(best, error);
    const Vec3 Pt = at.housing_theta(), PB = at.housing_B();
    const double rt = (P.x() * Pt.x() + P.y() * Pt.y()) / r_now, rB = (P.x() * PB.x() + P.y() * PB.y()) / r_now;
    const double det = rt * PB.z() - rB * Pt.z();
    if (det == 0) return false;
    double dt = (er * PB.z() - rB * ez) / det, dB = (rt * ez - er * Pt.z()) / det;
    const double size = std::max(std::abs(dt), std::abs(dB));
    if (size > 0.1) {
      dt *= 0.1 / size;
      dB *= 0.1 / size;
    }
    theta += dt;
    B += dB;
    if (std::abs(B) > kMaxB) return false;
    if (size < 1e-15) return error < 1e-12 * std::max(r, 1.0);
  }
  return best < 1e-12 * std::max(r, 1.0);
}

/// Root of g, whose values at x0 and x1 (any order) have opposite signs.
template <typename G>
double root_between(const G& g, double x0, double g0, double x1, double g1) {
  std::uintmax_t steps = 200;
  const boost::math::tools::eps_tolerance<double> tolerance(52);
  const auto bracket = x0 < x1 ? boost::math::tools::toms748_solve(g, x0, x1, g0, g1, tolerance, steps)
                               : boost::math::tools::toms748_solve(g, x1, x0, g1, g0, tolerance, steps);
  return 0.5 * (bracket.first + bracket.second);
}

/// For a given B the height alone gives theta; then the radius is a function of B only.
std::optional<FlankCoordinates> by_bracketing(const FaceGearSurface<double>& f, int s, double r, double z) {
  const auto theta_of = [&](double B) {
    const double nz = s * (f.shaper.sin_bb * f.Cg + std::sin(B) * f.shaper.cos_bb * f.Sg);
    const double Qz = f.flank_housing(s, 0.0, B).z();
    return nz > 1e-9 ? -(z - Qz) / nz * f.shaper.cos_bb / f.shaper.r_b : NAN;
  };
  const auto residual = [&](double B) {
    const double theta = theta_of(B);
    return std::isnan(theta) ? NAN : meridian(f, s, theta, B).r - r;
  };
  const auto regularity = [&](double B) { return f.flank_J(s, theta_of(B), B); };
  constexpr int kSamples = 400;
  double B0 = NAN, f0 = NAN, J0 = NAN;
  for (int k = 0; k <= kSamples; ++k) {
    double B1 = s * (kMaxB - (kMaxB + 0.6) * k / kSamples), f1 = residual(B1);
    const double J1 = std::isnan(f1) ? NAN : regularity(B1);
    const bool edge = !std::isnan(f0) && J1 <= 0;
    if (edge) {  // the sheet ends between the two samples: go up to its edge, where r has its extreme
      B1 = root_between(regularity, B0, J0, B1, J1);
      f1 = residual(B1);
    }
    if (!std::isnan(f0) && (J1 > 0 || edge) && f0 * f1 <= 0) {
      const double B = root_between(residual, B0, f0, B1, f1), theta = theta_of(B), J = f.flank_J(s, theta, B);
      if (J > 0) return FlankCoordinates{theta, B, J};
    }
    B0 = B1;
    f0 = J1 > 0 ? f1 : NAN;
    J0 = J1;
  }
  return {};
}

/// Radius of the fillet point at section Z; NaN where the edge has no contact.
struct FilletRadius {
  const FaceGearSurface<double>& f;
  int side;
  double A;
  double operator()(double Z) const {
    const auto p = f.fillet(side, A, Z);
    return p.defined ? std::hypot(p.p.x(), p.p.y()) : NAN;
  }
};

/// Secant from a section nearby. Only an arrival on the regular sheet counts, where the radius grows with Z.
std::optional<double> fillet_by_secant(const FilletRadius& radius, double r, double start_Z) {
  double Z0 = start_Z, e0 = radius(Z0) - r;
  double Z1 = Z0 - e0, e1 = radius(Z1) - r, slope = 1;
  double best = INFINITY;
  for (int k = 0; k < kNewtonLimit; ++k) {
    if (!(std::abs(e1) < INFINITY) || !(slope > 0)) return {};
    const bool settled = std::abs(e1) <= 4e-16 * r || Z1 == Z0 || e1 == e0;
    if (std::abs(e1) <= 1e-12 * r && (settled || (k > 8 && std::abs(e1) >= 0.5 * best))) return Z1;
    if (settled) return {};
    best = std::min(best, std::abs(e1));
    if (std::abs(Z1 - Z0) > 1e-9 * r) slope = (e1 - e0) / (Z1 - Z0);
    const double Z2 = Z1 - e1 / slope;
    Z0 = Z1;
    e0 = e1;
    Z1 = Z2;
    e1 = radius(Z1) - r;
  }
  return {};
}

/// From a section that lies outside r for certain inwards to the first crossing: the regular sheet is the outermost.
/// Below it the contact may end (the radius is no number there); then the bracket closes on that end.
std::optional<double> fillet_by_bracketing(const FilletRadius& radius, double r) {
  const auto& f = radius.f;
  const double step = 0.05 * f.shaper.m_t;
  // r >= Z sin(gamma) - r_a |cos(gamma)| for every point of the shaper's section Z.
  double Z0 = (r + f.shaper.r_a * std::abs(f.Cg)) / f.Sg, e0 = radius(Z0) - r;
  if (std::isnan(e0)) return {};
  if (e0 <= 0) return e0 == 0 ? std::optional(Z0) : std::nullopt;
  while (Z0 > 0) {
    double Z1 = Z0 - step, e1 = radius(Z1) - r;
    for (int k = 0; k < kNewtonLimit && std::isnan(e1); ++k) {
      Z1 = 0.5 * (Z0 + Z1);
      if (Z1 >= Z0) return {};
      e1 = radius(Z1) - r;
      if (e1 > 0) {  // still outside: the end of the contact is further in
        Z0 = Z1;
        e0 = e1;
        Z1 = Z0 - step * std::ldexp(1.0, -k - 1);
        e1 = radius(Z1) - r;
      }
    }
    if (std::isnan(e1)) return {};
    if (e1 <= 0) {
      std::uintmax_t steps = 200;
      const auto error = [&](double Z) { return radius(Z) - r; };
      const auto bracket = boost::math::tools::toms748_solve(error, Z1, Z0, e1, e0,
                                                             boost::math::tools::eps_tolerance<double>(52), steps);
      const double Z =
          std::abs(error(bracket.first)) < std::abs(error(bracket.second)) ? bracket.first : bracket.second;
      return std::abs(error(Z)) <= 1e-12 * r ? std::optional(Z) : std::nullopt;
    }
    Z0 = Z1;
    e0 = e1;
  }
  return {};
}

/// Newton from a B nearby.
std::optional<double> flank_B_by_newton(const FaceGearSurface<double>& f, int side, double theta, double r,
                                        double start_B) {
  double B = start_B;
  for (int k = 0; k < kNewtonLimit; ++k) {
    const FaceGearSurface<double>::FlankPlace at(f, side, theta, B);
    const Vec3 P = at.housing(), PB = at.housing_B();
    const double r_now = std::hypot(P.x(), P.y());
    const double rB = (P.x() * PB.x() + P.y() * PB.y()) / r_now;
    double dB = (r - r_now) / rB;
    if (!(std::abs(dB) < INFINITY)) return {};
    dB = std::clamp(dB, -0.1, 0.1);
    B += dB;
    if (std::abs(B) > kMaxB) return {};
    if (std::abs(dB) < 1e-14) {
      if (std::abs(meridian(f, side, theta, B).r - r) > 1e-11 * r || !(f.flank_J(side, theta, B) > 0)) return {};
      return B;
    }
  }
  const double error = std::abs(meridian(f, side, theta, B).r - r);
  if (error > 1e-12 * r || !(f.flank_J(side, theta, B) > 0)) return {};
  return B;
}

/// The same from the outermost place of the line inwards to the first crossing, as far as the line is regular.
std::optional<double> flank_B_by_bracketing(const FaceGearSurface<double>& f, int side, double theta, double r) {
  const auto error = [&](double B) { return meridian(f, side, theta, B).r - r; };
  const auto regularity = [&](double B) { return f.flank_J(side, theta, B); };
  constexpr int kSamples = 400;
  double B0 = side * kMaxB, e0 = error(B0), J0 = regularity(B0);
  for (int k = 1; k <= kSamples && J0 > 0; ++k) {
    double B1 = side * (kMaxB - (kMaxB + 0.6) * k / kSamples), J1 = regularity(B1);
    const bool edge = !(J1 > 0);
    if (edge) {
      if (!(J1 < 0)) return {};
      B1 = root_between(regularity, B0, J0, B1, J1);
    }
    const double e1 = error(B1);
    if (e0 * e1 <= 0) {
      const double B = root_between(error, B0, e0, B1, e1);
      if (std::abs(error(B)) <= 1e-11 * r && regularity(B) > 0) return B;
      return {};
    }
    if (edge) return {};
    B0 = B1;
    e0 = e1;
    J0 = J1;
  }
  return {};
}

}  // namespace

std::optional<FlankCoordinates> invert_flank(const FaceGearSurface<double>& f, int side, double r, double z,
                                             const std::optional<FlankCoordinates>& start) {
  if (!(r > f.M2)) return {};
  double theta = start ? start->theta : std::tan(f.shaper.alpha_t),
         B = start ? start->B : regular_start_B(f, side, theta);
  const Meridian from = meridian(f, side, theta, B);
  const double distance = std::hypot(r - from.r, z - from.z), step = 0.5 * f.shaper.m_t;
  const int steps = std::clamp(int(std::ceil(distance / step)), 1, 400);
  bool ok = true;
  int iterations = 0;
  for (int k = 1; k <= steps && ok; ++k) {
    const double t = double(k) / steps;
    ok = newton(f, side, k == steps ? r : from.r + t * (r - from.r), k == steps ? z : from.z + t * (z - from.z), theta,
                B, iterations);
  }
  if (ok) {
    const double J = f.flank_J(side, theta, B);
    // Beyond theta = 0 a flank continues as the other one: let the outermost solution decide there.
    if (J > 0 && theta >= 0) return FlankCoordinates{theta, B, J, iterations};
    if (J > 0) {
      const auto outermost = by_bracketing(f, side, r, z);
      return outermost ? outermost : FlankCoordinates{theta, B, J, iterations};
    }
  }
  return by_bracketing(f, side, r, z);
}

double flank_azimuth(const FaceGearSurface<double>& f, int side, const FlankCoordinates& at) {
  const Vec3 P = f.flank_housing(side, at.theta, at.B);
  return std::atan2(P.y(), P.x()) - f.i * f.flank_phi(side, at.theta, at.B);
}

std::optional<FlankDistance> flank_distance(const FaceGearSurface<double>& f, int side, const Vec3& point,
                                            const std::optional<FlankCoordinates>& start) {
  const auto at = invert_flank(f, side, std::hypot(point.x(), point.y()), point.z(), start);
  if (!at) return {};
  const double turn = std::remainder(std::atan2(point.y(), point.x()) - flank_azimuth(f, side, *at), 2 * kPi);
  FlankDistance d;
  d.distance = side * f.M2 * turn;
  d.foot = {at->theta + d.distance * f.shaper.cos_bb / f.shaper.r_b, at->B, 0};
  d.foot.J = f.flank_J(side, d.foot.theta, d.foot.B);
  return d;
}

double regular_start_B(const FaceGearSurface<double>& f, int side, double theta) {
  constexpr double kStep = 0.02;
  double B = side * f.shaper.alpha_t;
  while (!(f.flank_J(side, theta, B) > 0) && std::abs(B) + kStep < kMaxB) B += side * kStep;
  return B;
}

std::optional<double> flank_B_at_radius(const FaceGearSurface<double>& f, int side, double theta, double r,
                                        double start_B) {
  if (const auto B = flank_B_by_newton(f, side, theta, r, start_B)) return B;
  return flank_B_by_bracketing(f, side, theta, r);
}

std::optional<double> fillet_Z_at_radius(const FaceGearSurface<double>& f, int side, double A, double r,
                                         double start_Z) {
  if (!(r > 0 && r < INFINITY)) return {};
  const FilletRadius radius{f, side, A};
  if (const auto Z = fillet_by_secant(radius, r, start_Z)) return Z;
  return fillet_by_bracketing(radius, r);
}

}  // namespace toothpath::face_gear
