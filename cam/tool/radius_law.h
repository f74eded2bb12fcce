// The radius law rho(t) of a mill with a ball end: the balls about its axis whose envelope is its side.
//
// t is the height above the centre of the ball end, rho the radius of the ball there that touches the side: the length
// of the meridian's normal from the axis, not the radius of a section. All laws are tangent to the ball end, rho(0) =
// r_0 and rho'(0) = sin(tau). Derivation: docs/line_milling.md, section 2.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace toothpath::tool {

/// A measured error f of rho along t: straight through its points, as a cubic with the slope of the neighbours at each
/// point. Points: t ascending [mm], f [mm], at least two. Asked outside of its range it goes on straight: the planner
/// refuses to use that.
struct MeridianError {
  std::vector<double> t, f;

  template <typename S>
  struct Value {
    S f{}, slope{};
  };
  template <typename S>
  [[nodiscard]] Value<S> at(const S& x) const {
    const std::size_t n = t.size();
    if (x < S(t.front())) return {S(f.front()) + S(slope(0)) * (x - S(t.front())), S(slope(0))};
    if (x > S(t.back())) return {S(f.back()) + S(slope(n - 1)) * (x - S(t.back())), S(slope(n - 1))};
    std::size_t k = 0;
    while (k + 2 < n && x > S(t[k + 1])) ++k;
    const S h(t[k + 1] - t[k]), u = (x - S(t[k])) / h, w = S(1) - u;
    const S m0 = h * S(slope(k)), m1 = h * S(slope(k + 1)), f0(f[k]), f1(f[k + 1]);
    return {w * w * (S(1) + S(2) * u) * f0 + u * u * (S(3) - S(2) * u) * f1 + u * w * (w * m0 - u * m1),
            S(6) * u * w * (f1 - f0) / h + w * (w - S(2) * u) * m0 / h + u * (u - S(2) * w) * m1 / h};
  }
  /// Largest f over the range, between the points too.
  [[nodiscard]] double largest() const {
    double most = *std::max_element(f.begin(), f.end());
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      // With m0, m1 the slopes per interval and d the rise: f' = m0 + 2 u (3 d - 2 m0 - m1) + 3 u^2 (m0 + m1 - 2 d).
      const double h = t[k + 1] - t[k], d = f[k + 1] - f[k], m0 = h * slope(k), m1 = h * slope(k + 1);
      const double a = 3 * (m0 + m1 - 2 * d), b = 3 * d - 2 * m0 - m1, root = b * b - a * m0;
      if (root < 0) continue;
      const double q = -(b + std::copysign(std::sqrt(root), b));
      for (const double u : {a != 0 ? q / a : -1, q != 0 ? m0 / q : -1})
        if (u > 0 && u < 1) most = std::max(most, at(t[k] + u * h).f);
    }
    return most;
  }

 private:
  [[nodiscard]] double slope(std::size_t k) const {
    const std::size_t a = k > 0 ? k - 1 : k, b = k + 1 < t.size() ? k + 1 : k;
    return (f[b] - f[a]) / (t[b] - t[a]);
  }
};

/// Cone (tau > 0), cylinder (tau = 0), or a side whose meridian is an arc. Lengths mm.
template <typename S>
struct RadiusLaw {
  S r_0{};  ///< of the ball end
  S sin_tau{0}, cos_tau{1};
  S R_m{0};  ///< radius of the meridian: > 0 convex (barrel, R_m > r_0), < 0 hollow, 0 straight
  std::shared_ptr<const MeridianError> error = nullptr;  ///< measured; none: the nominal form

  /// rho(t), t >= 0.
  [[nodiscard]] S rho(const S& t) const { return error ? S(nominal(t) + error->at(t).f) : nominal(t); }
  /// rho'(t): the sine of the angle between the axis and the side.
  [[nodiscard]] S slope(const S& t) const {
    const S s = straight() ? sin_tau : S(S(sense()) * (offset() * sin_tau - t) / root(t));
    return error ? S(s + error->at(t).slope) : s;
  }
  /// rho''(t) of the nominal form: 0 for a cone, < 0 for a barrel.
  [[nodiscard]] S bend(const S& t) const {
    if (straight()) return S(0);
    const S q = root(t), w = offset() * cos_tau;
    return S(-sense()) * w * w / (q * q * q);
  }

 private:
  // Convex with S = R_m - r_0: rho = R_m - hypot(S cos(tau), t - S sin(tau)); hollow is the same with R_m < 0 and the
  // other root.
  [[nodiscard]] bool straight() const { return R_m == S(0); }
  [[nodiscard]] int sense() const { return R_m > S(0) ? 1 : -1; }
  [[nodiscard]] S offset() const { return R_m - r_0; }
  [[nodiscard]] S root(const S& t) const {
    using std::sqrt;
    const S x = offset() * cos_tau, y = t - offset() * sin_tau;
    return sqrt(S(x * x + y * y));
  }
  [[nodiscard]] S nominal(const S& t) const {
    return straight() ? S(r_0 + t * sin_tau) : S(R_m - S(sense()) * root(t));
  }
};

}  // namespace toothpath::tool
