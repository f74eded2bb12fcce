// The ellipse of Hertz by complete elliptic integrals.
#pragma once

#include <cmath>
#include <numbers>

namespace toothpath::test {

struct HertzEllipse {
  double a = 0, b = 0;  ///< half axes, along and across, mm
  double pressure = 0, approach = 0;
};

/// @param k1, k2  principal relative curvatures, k1 > k2 > 0, 1/mm; equal ones a hair apart
inline HertzEllipse hertz_ellipse(double force, double modulus, double k1, double k2) {
  if (k1 == k2) k2 *= 1 - 1e-9;
  double low = 0, high = 1 - 1e-12;  // e^2
  const auto sides = [](double m) {  // k2/k1 that an ellipse of this m belongs to
    const double e = std::sqrt(m), K = std::comp_ellint_1(e), E = std::comp_ellint_2(e);
    return (1 - m) * (K - E) / (E - (1 - m) * K);
  };
  for (int n = 0; n < 200; ++n) {
    const double middle = (low + high) / 2;
    (sides(middle) > k2 / k1 ? low : high) = middle;
  }
  const double pi = std::numbers::pi, m = low, e = std::sqrt(m), K = std::comp_ellint_1(e), E = std::comp_ellint_2(e);
  // k2/2 = p0 b (K - E)/(E* a^2 e^2), p0 = 3 F/(2 pi a b); approach = p0 b K/E*.
  HertzEllipse out;
  const double bend = m > 1e-6 ? (K - E) / m : pi / 4 * (1 + 3 * m / 8);
  out.a = std::cbrt(3 * force * bend / (pi * modulus * k2));
  out.b = out.a * std::sqrt(1 - m);
  out.pressure = 1.5 * force / (pi * out.a * out.b);
  out.approach = out.pressure * out.b * K / modulus;
  return out;
}

}  // namespace toothpath::test
