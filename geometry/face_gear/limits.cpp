#include "geometry/face_gear/limits.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"

namespace toothpath::face_gear {
namespace {

constexpr double kFarInside = 0.6;   // the walk for the cusp goes on to s B = -0.6
constexpr double kScanStep = 0.005;  // of B, rad: far below the distance of two roots of one sign change

double radius_of(const Vec3& P) { return std::hypot(P.x(), P.y()); }

/// Root of a continuous f between x0 and x1 (any order), whose values there have opposite signs. To the last bits.
template <typename F>
double bracketed_root(F f, double x0, double f0, double x1, double f1) {
  if (f0 == 0) return x0;
  if (f1 == 0) return x1;
  const auto converged = [](double x, double y) {
    return std::abs(x - y) <= 2 * std::numeric_limits<double>::epsilon() * std::max(std::abs(x), std::abs(y));
  };
  std::uintmax_t steps = 100;
  const auto bracket = x0 < x1 ? boost::math::tools::toms748_solve(f, x0, x1, f0, f1, converged, steps)
                               : boost::math::tools::toms748_solve(f, x1, x0, f1, f0, converged, steps);
  return 0.5 * (bracket.first + bracket.second);
}

/// First sign change of f on the walk from `start` towards `end`; values that are not numbers are stepped over.
template <typename F>
std::optional<double> first_root(F f, double start, double end) {
  const int steps = std::max(1, int(std::ceil(std::abs(end - start) / kScanStep)));
  double x0 = start, f0 = f(start);
  for (int k = 1; k <= steps; ++k) {
    const double x1 = start + (end - start) * k / steps, f1 = f(x1);
    if (std::isfinite(f0) && std::isfinite(f1) && (f0 > 0) != (f1 > 0)) return bracketed_root(f, x0, f0, x1, f1);
    x0 = x1;
    f0 = f1;
  }
  return {};
}

/// B of the cusp of the line theta = theta_t, where its J vanishes.
std::optional<double> cusp_B(const FaceGearSurface<double>& f, int side) {
  const double theta_t = f.shaper.theta_t;
  const auto J = [&](double B) { return f.flank_J(side, theta_t, B); };
  const double pitch_B = side * f.shaper.alpha_t;
  return J(pitch_B) > 0 ? first_root(J, pitch_B, -side * kFarInside) : first_root(J, pitch_B, side * kMaxB);
}

/// B of the point theta = 0 on the tip surface.
std::optional<double> involute_start_B(const FaceGearSurface<double>& f, int side) {
  const auto above_tip = [&](double B) {
    const Vec3 Q = f.flank_housing(side, 0.0, B);
    const double r = radius_of(Q);
    return r > std::abs(f.E) ? Q.z() - f.z_tip(r) : std::numeric_limits<double>::quiet_NaN();
  };
  // From far outside, where the base line stands above the tip surface, inwards: the first crossing is the outermost.
  const auto B = first_root(above_tip, side * kMaxB, -side * kFarInside);
  if (!B || !(f.flank_J(side, 0.0, *B) > 0)) return {};
  return B;
}

/// B at which the line theta = theta_t comes down through the tip surface; none if it lies below it from the cusp on.
std::optional<double> flank_start_B(const FaceGearSurface<double>& f, int side, const std::optional<double>& cusp) {
  const auto above_tip = [&](double B) {
    const Vec3 P = f.flank_housing(side, f.shaper.theta_t, B);
    const double r = radius_of(P);
    return r > std::abs(f.E) ? P.z() - f.z_tip(r) : std::numeric_limits<double>::quiet_NaN();
  };
  const double start = cusp ? *cusp : 0.0;
  if (!(above_tip(start) > 0)) return {};
  return first_root(above_tip, start, side * kMaxB);
}

/// B at which the line theta = theta_t rises through the tip surface again; `inner` is where the flank begins.
std::optional<double> flank_end_B(const FaceGearSurface<double>& f, int side, double inner) {
  const auto above_tip = [&](double B) {
    const Vec3 P = f.flank_housing(side, f.shaper.theta_t, B);
    const double r = radius_of(P);
    return r > std::abs(f.E) ? P.z() - f.z_tip(r) : std::numeric_limits<double>::quiet_NaN();
  };
  // A step outside the beginning, where the line may lie on the tip surface itself.
  const double start = inner + side * kScanStep;
  if (!(above_tip(start) < 0)) return {};
  return first_root(above_tip, start, side * kMaxB);
}

FlankLimits flank_limits(const FaceGearSurface<double>& f, int side) {
  FlankLimits limits;
  limits.side = side;
  if (const auto B = cusp_B(f, side)) {
    const Vec3 P = f.flank_housing(side, f.shaper.theta_t, *B);
    limits.undercut_B = *B;
    limits.undercut_radius = radius_of(P);
    limits.undercut_height = P.z();
  }
  const auto start_B = flank_start_B(f, side, limits.undercut_B);
  if (start_B) limits.flank_start_radius = radius_of(f.flank_housing(side, f.shaper.theta_t, *start_B));
  if (const auto B = flank_end_B(f, side, start_B.value_or(limits.undercut_B.value_or(0.0))))
    limits.flank_end_radius = radius_of(f.flank_housing(side, f.shaper.theta_t, *B));
  if (const auto B = involute_start_B(f, side))
    limits.involute_start_radius = radius_of(f.flank_housing(side, 0.0, *B));
  return limits;
}

/// Thickness of the tooth on the tip surface, each flank found from where it was found last.
class TipThickness {
 public:
  explicit TipThickness(const FaceGearSurface<double>& surface) : f_(surface) {}

  std::optional<double> operator()(double r) {
    if (!(r > f_.M2) || !(r > std::abs(f_.E))) return {};
    const double z = f_.z_tip(r);
    double azimuth[2];
    for (const int k : {0, 1}) {
      const int side = k == 0 ? 1 : -1;
      auto at = invert_flank(f_, side, r, z, last_[k]);
      if (!at && last_[k]) at = invert_flank(f_, side, r, z);
      if (!at) return {};
      last_[k] = at;
      azimuth[k] = flank_azimuth(f_, side, *at);
    }
    return r * (azimuth[0] - azimuth[1]);
  }

 private:
  const FaceGearSurface<double>& f_;
  std::optional<FlankCoordinates> last_[2];
};

/// Radius at which the tooth on the tip surface is `land` thick. The walk starts far outside, where both involutes are
/// long and unmistakable, and goes inwards with each flank found from the step before: the continuation of a flank
/// beyond theta = 0 is the other flank, so near the base circle a cold start can end on the wrong one.
std::optional<double> radius_of_thickness(const FaceGearSurface<double>& f, double land) {
  TipThickness thickness(f);
  const double pitch_radius = radius_of(f.flank_housing(1, std::tan(f.shaper.alpha_t), f.shaper.alpha_t));
  const double step = std::max(0.25 * f.shaper.m_t, 0.005 * pitch_radius);
  std::optional<double> S0;
  double r0 = 0;
  for (const double far : {1.6, 1.4, 1.25, 1.15, 2.0, 2.5, 3.2}) {  // beyond 1.6: teeth that keep a land for long
    r0 = far * pitch_radius;
    S0 = thickness(r0);
    if (S0 && *S0 <= land) break;
  }
  if (!S0 || *S0 > land) return {};
  for (double r1 = r0 - step; r1 > std::max(f.M2, std::abs(f.E)); r1 -= step) {
    const auto S1 = thickness(r1);
    if (!S1) return {};
    if (*S1 > land) {
      const auto spare = [&](double r) {
        return thickness(r).value_or(std::numeric_limits<double>::quiet_NaN()) - land;
      };
      const double r = bracketed_root(spare, r1, *S1 - land, r0, *S0 - land);
      return std::isfinite(r) ? std::optional(r) : std::nullopt;
    }
    r0 = r1;
    S0 = S1;
  }
  return {};
}

}  // namespace

std::optional<double> tip_thickness(const FaceGearSurface<double>& surface, double r) {
  return TipThickness(surface)(r);
}

std::optional<double> fillet_line_height(const FaceGearSurface<double>& f, int side, double r) {
  const double theta_t = f.shaper.theta_t;
  const auto residual = [&](double B) { return radius_of(f.flank_housing(side, theta_t, B)) - r; };
  const auto cusp = cusp_B(f, side);
  const double inner_B = cusp ? *cusp : -side * kFarInside;
  // From steep to flat: the first crossing is the one of the regular sheet.
  const auto B = first_root(residual, side * kMaxB, inner_B);
  if (!B || !(f.flank_J(side, theta_t, *B) > 0)) return {};
  return f.flank_housing(side, theta_t, *B).z();
}

std::optional<double> root_height(const FaceGearSurface<double>& f, double r) {
  if (!(r > std::abs(f.E))) return {};
  double x = f.shaper.r_a, y = 0, Z = 0;
  for (int k = 0; k < 100; ++k) {
    const double reach = r * r - (f.E + y) * (f.E + y);
    if (!(reach > 0)) return {};
    const double Z_next = (std::sqrt(reach) + x * f.Cg) / f.Sg;
    if (!(Z_next > 0)) return {};
    const bool settled = std::abs(Z_next - Z) <= 4 * std::numeric_limits<double>::epsilon() * Z_next;
    Z = Z_next;
    if (settled) return f.root_meridian(Z).p.z();
    const double tan_w = -f.E * f.Cg / (Z * f.Sg), cos_w = 1 / std::sqrt(1 + tan_w * tan_w);
    x = f.shaper.r_a * cos_w;
    y = f.shaper.r_a * tan_w * cos_w;
  }
  return f.root_meridian(Z).p.z();
}

ZoneLimits zone_limits(const FaceGearSurface<double>& surface, double module_mm, std::optional<double> least_land_mm) {
  ZoneLimits limits;
  limits.flanks = {flank_limits(surface, 1), flank_limits(surface, -1)};
  limits.practical_land_mm = least_land_mm.value_or(0.2 * module_mm);
  limits.pointing_radius = radius_of_thickness(surface, 0.0);
  limits.land_radius = radius_of_thickness(surface, limits.practical_land_mm);
  limits.hard_inner_limit = limits.inner_limit = surface.M2;
  limits.inner_limit_name = "base cylinder";
  for (const auto& flank : limits.flanks)
    if (flank.undercut_radius && *flank.undercut_radius > limits.inner_limit) {
      limits.hard_inner_limit = limits.inner_limit = *flank.undercut_radius;
      limits.inner_limit_name = "undercut";
    }
  for (const auto& flank : limits.flanks)
    if (flank.flank_start_radius && *flank.flank_start_radius > limits.inner_limit) {
      limits.hard_inner_limit = limits.inner_limit = *flank.flank_start_radius;
      limits.inner_limit_name = "fillet up to the tip";
    }
  for (const auto& flank : limits.flanks)
    if (flank.involute_start_radius && *flank.involute_start_radius > limits.inner_limit) {
      limits.inner_limit = *flank.involute_start_radius;
      limits.inner_limit_name = "involute start";
    }
  return limits;
}

}  // namespace toothpath::face_gear
