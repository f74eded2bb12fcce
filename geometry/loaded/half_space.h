// What a pressed strip does to the surface of an elastic half-space, and the line contact of Hertz. Lengths in mm,
// forces in N, E in MPa. Template on the scalar. Derivation: docs/loaded_contact.md 3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/vec.h"

namespace toothpath::loaded {

/// (1 - nu^2)/(pi E): displacement of a half-space at distance 1 under a force of 1, 1/MPa/mm.
template <typename S>
S half_space_compliance(const S& E, const S& nu) {
  using std::atan;
  return (S(1) - nu * nu) / (S(4) * atan(S(1)) * E);
}

/// 1/E* = sum of (1 - nu^2)/E of both bodies.
template <typename S>
S contact_modulus(const S& E1, const S& nu1, const S& E2, const S& nu2) {
  return S(1) / ((S(1) - nu1 * nu1) / E1 + (S(1) - nu2 * nu2) / E2);
}

/// Line contact of Hertz: half width and largest pressure under the load w [N/mm] at the relative curvature k [1/mm].
template <typename S>
struct HertzLine {
  S half_width{}, pressure{};
};
template <typename S>
HertzLine<S> hertz_line(const S& w, const S& modulus, const S& curvature) {
  using std::atan, std::sqrt;
  const S pi = S(4) * atan(S(1));
  return {S(sqrt(S(S(4) * w / (pi * modulus * curvature)))), S(sqrt(S(w * modulus * curvature / pi)))};
}

/// Half axes of the ellipse that a force presses, along the larger and the smaller curvature, within some per cent.
/// Source: Brewe and Hamrock 1977. @param k1, k2  relative curvatures, the larger first, 1/mm
template <typename S>
std::array<S, 2> ellipse_sides(const S& force, const S& modulus, const S& k1, const S& k2) {
  using std::atan, std::cbrt, std::max, std::pow;
  const S pi = S(4) * atan(S(1));
  const S ratio = max(S(1), S(k1 / max(k2, S(1e-9 * k1)))), round = pow(ratio, S(2 / pi));
  const S integral = 1 + (pi / 2 - 1) / ratio, size = 3 * force * integral / (pi * modulus * (k1 + k2));
  return {S(cbrt(size / round)), S(cbrt(size * round * round))};
}

/// Pressure under a line of contact that runs along a rounded edge: w [N/mm] of it, edge radius [mm], k the relative
/// curvature of the flanks, for that of the mate: either is small against 1/radius.
template <typename S>
S pressure_along_edge(const S& w, const S& modulus, const S& radius, const S& k) {
  return hertz_line(w, modulus, S(1 / radius + k)).pressure;
}
/// Under the end of a line of contact that crosses a rounded edge: an ellipse of the curvatures 1/radius and k under
/// the force of the last segment; an upper bound.
template <typename S>
S pressure_across_edge(const S& force, const S& modulus, const S& radius, const S& k) {
  using std::atan, std::max, std::min;
  const auto sides = ellipse_sides(force, modulus, max(S(1 / radius), k), min(S(1 / radius), k));
  return S(3 * force / (8 * atan(S(1)) * sides[0] * sides[1]));
}

/// Displacement at a place of the half-space under a strip of length D with a semi-ellipse of half width b across,
/// total force f: half_space_compliance * f * V / D. Source: Gauss-Chebyshev over the semi-ellipse with 16 places; the
/// logarithm at the strip's own line is repaired by its last term. Error of V <= 4e-4.
/// @param along, off  of the place from the centre of the strip, along it and off its line
/// @param own         the place is the strip's own centre
template <typename S>
S strip_influence(const S& along, const S& off, const S& length, const S& half_width, bool own) {
  using std::asinh, std::atan, std::cos, std::log, std::sin, std::sqrt;
  const S reach = length / S(2), square = along * along + off * off;
  if (!own && square > S(100) * half_width * half_width && square > S(4) * length * length) {
    const S d1 = sqrt(S((along + reach) * (along + reach) + off * off)),
            d2 = sqrt(S((along - reach) * (along - reach) + off * off));
    return log(S((d1 + d2 + length) / (d1 + d2 - length)));
  }
  constexpr int M = 16;
  const S pi = S(4) * atan(S(1));
  S sum(0);
  for (int q = 1; q <= M / 2; ++q) {  // places +-x weigh the same
    const S angle = pi * S(q) / S(M + 1), x = half_width * cos(angle), s = sin(angle);
    const S h = sqrt(S(off * off + x * x));
    sum += S(4) / S(M + 1) * s * s * (asinh(S((along + reach) / h)) - asinh(S((along - reach) / h)));
  }
  if (own) sum += S(4) * log(S(2)) / S(M + 1);
  return sum;
}

}  // namespace toothpath::loaded
