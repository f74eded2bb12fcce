// Tooth trace of the equal-base-circle bevel gear and its equidistants, on the crown plane.
//
// Crown plane: the pitch cone unrolled, polar coordinates (R, theta), theta = azimuth * sin(delta). The running
// parameter is the spiral angle beta, not R: R = R_0 cos^2(beta) is regular at the end of the trace (beta = 0).
// h = +1 right hand, -1 left hand; sigma = +1 wall L (lower azimuth), -1 wall U; eps = -sigma h. mm and rad.
// Derivation: docs/bevel_gear.md, sections 2 and 3.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "geometry/base/base_of.h"
#include "geometry/base/vec.h"
#include "geometry/bevel_gear/flank_law.h"

namespace toothpath::bevel_gear {

namespace bevel_detail {
/// True for scalars whose digits a short power series exhausts (double and its duals).
template <typename S>
inline constexpr bool kSeriesSuffices = std::numeric_limits<S>::digits10 <= 18;

template <typename S>
S magnitude(const S& a) {
  return a < S(0) ? S(-a) : a;
}
}  // namespace bevel_detail

/// tan(b) - b, |b| < pi/2, relative error below 4 eps: power series below 0.05 rad, where the difference loses digits.
template <typename S>
S tan_minus_angle(const S& b) {
  using std::tan;
  if constexpr (bevel_detail::kSeriesSuffices<S>) {
    if (bevel_detail::magnitude(b) < S(0.05)) {
      const S q = b * b;
      return b * q *
             (S(1.0 / 3) + q * (S(2.0 / 15) + q * (S(17.0 / 315) + q * (S(62.0 / 2835) + q * S(1382.0 / 155925)))));
    }
  }
  return tan(b) - b;
}

/// [tan(a) - a] - [tan(b) - b] without cancellation for close angles (below 1e-2 deg), |a|, |b| < pi/2.
template <typename S>
S tan_minus_angle_difference(const S& a, const S& b) {
  using std::sin, std::cos, std::tan;
  if constexpr (kEncloses<S>) return (tan(a) - a) - (tan(b) - b);
  const S d = a - b;
  if (bevel_detail::magnitude(d) < S(1.75e-4) && bevel_detail::magnitude(a) > S(0.05)) {
    // tan a - tan b - d = d tan a tan b + (tan d - d)(1 + tan a tan b)
    const S t = tan(a) * tan(b);
    return d * t + tan_minus_angle(d) * (S(1) + t);
  }
  return tan_minus_angle(a) - tan_minus_angle(b);
}

/// Where the cutter axis meets the pitch cone, and how it goes on from there.
template <typename S>
struct CutterCentre {
  S R_c{};      ///< cone distance, mm
  S theta_c{};  ///< crown plane angle, rad
  S e{};        ///< azimuth in the blank frame, rad
  S beta_c{};   ///< signed spiral angle of the centre path
};

/// Distance of a cutter-centre path from the trace, and its derivatives with the arc length of the trace.
template <typename S>
struct PathDistance {
  S d{}, slope{}, bend{};
};

/// One hand of teeth: its trace, and the cutter-centre paths that are parallel to it, or nearer where a wall is
/// modified along the face.
template <typename S>
struct BevelTrace {
  S R_0{};  ///< cone distance where beta = 0: the trace ends here
  S sin_delta{}, cos_delta{};
  S beta_ref{};  ///< spiral angle at R_ref, where theta = 0
  S r_0{};       ///< half width of the cutter at the pitch cone, pi m_nj / 4
  S e_h{};       ///< half angle of the tooth space, azimuth
  int h = 1;     ///< hand
  S beta_end{};  ///< > 0: the path of eps = +1 goes on straight below this spiral angle, short of its cusp
  std::shared_ptr<const LeadLaw> lead[2];  ///< of walls L, U; null: the path is parallel to the trace

  [[nodiscard]] const LeadLaw* lead_of(int sigma) const { return lead[sigma > 0 ? 0 : 1].get(); }
  /// Distance of the path of wall sigma from the trace: r_0 less what the modification takes.
  [[nodiscard]] PathDistance<S> distance(int sigma, const S& beta) const {
    using std::cos;
    const LeadLaw* law = lead_of(sigma);
    if (!law) return {r_0, S(0), S(0)};
    const S way(law->per_normal), cone = R(beta), along = cos(beta);  // dR/ds = cos(beta), its derivative 1/(2 R_0)
    const S first = law->removed.derivative(cone, 1), second = law->removed.derivative(cone, 2);
    return {S(r_0 - way * law->removed.derivative(cone, 0)), S(-way * first * along),
            S(-way * (second * along * along + first / (S(2) * R_0)))};
  }

  /// Spiral angle at cone distance R, 0 < R <= R_0 (rounding beyond R_0 is clamped); 0 .. pi/2.
  [[nodiscard]] S beta(const S& R) const {
    using std::sqrt, std::atan2;
    const S rest = R_0 - R;
    return atan2(sqrt(rest > S(0) ? S(rest / R_0) : S(0)), sqrt(S(R / R_0)));
  }
  [[nodiscard]] S R(const S& beta) const {
    using std::cos;
    const S c = cos(beta);
    return R_0 * c * c;
  }
  /// Polar angle of the trace, theta(R_ref) = 0.
  [[nodiscard]] S theta(const S& beta) const { return S(2 * h) * tan_minus_angle_difference(beta_ref, beta); }
  /// Arc length from the pole.
  [[nodiscard]] S arc(const S& beta) const {
    using std::cos;
    return S(2) * R_0 * cos(beta);
  }
  /// Curvature, left normal positive; beta > 0. Zero at tan^2(beta) = 1/2.
  [[nodiscard]] S kappa(const S& beta) const {
    using std::sin, std::tan;
    const S t = tan(beta);
    return S(h) * (S(2) * t * t - S(1)) / (S(2) * R_0 * sin(beta));
  }
  /// dC/ds of the path of wall sigma against the trace, sign included. At beta = 0 the end of the trace is a
  /// cusp: minus infinity for eps = +1, plus infinity for eps = -1.
  [[nodiscard]] S speed_ratio(int sigma, const S& beta) const {
    using std::sin, std::tan;
    const S sb = sin(beta), t = tan(beta), eps = S(-sigma * h);
    const PathDistance<S> off = distance(sigma, beta);
    const S num = eps * off.d * (S(2) * t * t - S(1));
    if (sb == S(0))
      return num < S(0) ? S(-std::numeric_limits<double>::infinity()) : S(std::numeric_limits<double>::infinity());
    const S along = S(1) + num / (S(2) * R_0 * sb);
    if (!lead_of(sigma)) return along;
    using std::sqrt;
    const S speed = sqrt(S(along * along + off.slope * off.slope));
    return along < S(0) ? S(-speed) : speed;
  }
  /// Turn of the path's tangent in the crown plane per arc length of the trace; that of the trace where the path is
  /// parallel to it. beta > 0.
  [[nodiscard]] S turn(int sigma, const S& beta) const {
    if (!lead_of(sigma)) return kappa(beta);
    using std::sin, std::cos, std::tan;
    const S sb = sin(beta), cb = cos(beta), t = tan(beta), side = S(sigma), bends = kappa(beta);
    const S rise = S(-h) / (S(4) * R_0 * R_0 * sb) *
                   (S(4) * t * (S(1) + t * t) / sb - (S(2) * t * t - S(1)) * cb / (sb * sb));  // d kappa/ds
    const PathDistance<S> off = distance(sigma, beta);
    const S a = S(1) - side * off.d * bends, b = side * off.slope;
    return bends + (a * side * off.bend + b * side * (off.slope * bends + off.d * rise)) / (a * a + b * b);
  }
  /// Does the path of wall sigma run straight at this parameter?
  [[nodiscard]] bool straight(int sigma, const S& beta) const { return -sigma * h > 0 && beta < beta_end; }
  /// Cutter centre of wall sigma at spiral angle beta of the trace; finite also at beta = 0. Below beta_end (eps = +1)
  /// the path is the tangent at beta_end in the crown plane, run at the same speed per beta, also for beta < 0.
  [[nodiscard]] CutterCentre<S> centre(int sigma, const S& beta) const {
    if (!straight(sigma, beta)) return curved_centre(sigma, beta);
    using std::sin;
    const S speed = speed_ratio(sigma, beta_end) * S(2) * R_0 * sin(beta_end);
    return run_straight(curved_centre(sigma, beta_end), S(speed * (beta_end - beta)));
  }
  /// The centre `length` further along the tangent in the crown plane (length < 0: back).
  [[nodiscard]] CutterCentre<S> run_straight(const CutterCentre<S>& from, const S& length) const {
    using std::sin, std::cos, std::sqrt, std::atan2;
    const S u = from.R_c + length * cos(from.beta_c), v = length * sin(from.beta_c), turn = atan2(v, u);
    CutterCentre<S> c;
    c.R_c = sqrt(S(u * u + v * v));
    c.theta_c = from.theta_c + turn;
    c.e = c.theta_c / sin_delta;
    c.beta_c = from.beta_c - turn;
    return c;
  }
  /// The path itself, never straightened.
  [[nodiscard]] CutterCentre<S> curved_centre(int sigma, const S& beta) const {
    using std::sin, std::cos, std::sqrt, std::atan2;
    const S eps = S(-sigma * h), sb = sin(beta), cb = cos(beta), r = R_0 * cb * cb;
    const PathDistance<S> off = distance(sigma, beta);
    const S u = r + eps * off.d * sb, v = off.d * cb;
    const S theta_d = atan2(v, u);
    CutterCentre<S> c;
    c.R_c = sqrt(S(u * u + v * v));
    c.theta_c = theta(beta) + S(sigma) * theta_d - S(sigma) * e_h * sin_delta;
    c.e = c.theta_c / sin_delta;
    c.beta_c = S(h) * (beta + eps * theta_d);
    if (lead_of(sigma)) {  // the path leans against the trace; both times sin(beta), which is regular at its end
      const S t = sb / cb;
      c.beta_c =
          c.beta_c + atan2(S(S(sigma) * off.slope * sb), S(sb + eps * off.d * (S(2) * t * t - S(1)) / (S(2) * R_0)));
    }
    return c;
  }
  /// Angle between the polar rays of trace and centre.
  [[nodiscard]] S theta_d(int sigma, const S& beta) const {
    using std::sin, std::cos, std::atan2;
    const S eps = S(-sigma * h), cb = cos(beta), d = distance(sigma, beta).d;
    return atan2(S(d * cb), S(R_0 * cb * cb + eps * d * sin(beta)));
  }
  /// Middle of the tooth space: the trace itself.
  [[nodiscard]] CutterCentre<S> middle(const S& beta) const {
    CutterCentre<S> c;
    c.R_c = R(beta);
    c.theta_c = theta(beta);
    c.e = c.theta_c / sin_delta;
    c.beta_c = S(h) * beta;
    return c;
  }
  /// de/dR_c on a centre path.
  [[nodiscard]] S rate(const CutterCentre<S>& c) const {
    using std::tan;
    return tan(c.beta_c) / (c.R_c * sin_delta);
  }
  /// Largest cone distance of a pass: the equidistant keeps F >= 0.17 up to here.
  [[nodiscard]] S R_lim() const { return R_0 - S(0.36) * r_0 * r_0 / R_0; }
};

/// Point of the blank frame from cutter-frame coordinates (axis tip to shank, azimuthal, generatrix outwards).
template <typename S>
Vec3T<S> blank_from_cutter(const S& x, const S& y, const S& z, const S& R_c, const S& e, const S& sd, const S& cd) {
  using std::sin, std::cos;
  const S q = x * cd + (z + R_c) * sd, ce = cos(e), se = sin(e);
  return {S(q * ce - y * se), S(q * se + y * ce), S((z + R_c) * cd - x * sd)};
}

/// The other way.
template <typename S>
Vec3T<S> cutter_from_blank(const Vec3T<S>& p, const S& R_c, const S& e, const S& sd, const S& cd) {
  using std::sin, std::cos;
  const S ce = cos(e), se = sin(e), qx = p[0] * ce + p[1] * se;
  return {S(qx * cd - p[2] * sd), S(p[1] * ce - p[0] * se), S(qx * sd + p[2] * cd - R_c)};
}

/// Generatrix coordinates of a blank point: along the pitch cone, normal to it, azimuth.
struct ConePoint {
  double ell = 0, height = 0, azimuth = 0;
};
[[nodiscard]] inline ConePoint cone_point(const Vec3& p, double sd, double cd) {
  const double r = std::hypot(p.x(), p.y());
  return {r * sd + p.z() * cd, r * cd - p.z() * sd, std::atan2(p.y(), p.x())};
}
[[nodiscard]] inline Vec3 blank_point(double ell, double height, double azimuth, double sd, double cd) {
  const double r = ell * sd + height * cd;
  return {r * std::cos(azimuth), r * std::sin(azimuth), ell * cd - height * sd};
}

}  // namespace toothpath::bevel_gear
