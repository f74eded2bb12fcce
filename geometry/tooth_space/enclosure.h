// Place and derivatives of a piece over a box of its parameters, enclosed by interval arithmetic in the very kernel
// that makes the surface.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "geometry/base/dual.h"
#include "geometry/base/interval.h"
#include "geometry/base/vec.h"

namespace toothpath::tooth_space {

/// Affine coordinates (a, b) in the plane of the parameters (u, v) of a piece: the cells of a sheet are oblique in (u,
/// v).
struct PatchFrame {
  Vec2 origin = Vec2::Zero(), along_a = Vec2::UnitX(), along_b = Vec2::UnitY();
  [[nodiscard]] Vec2 uv(const Vec2& ab) const { return origin + ab.x() * along_a + ab.y() * along_b; }
  [[nodiscard]] Vec2 ab(const Vec2& uv) const {
    const Vec2 d = uv - origin;
    const double det = along_a.x() * along_b.y() - along_a.y() * along_b.x();
    return {(d.x() * along_b.y() - d.y() * along_b.x()) / det, (along_a.x() * d.y() - along_a.y() * d.x()) / det};
  }
};

/// Value and first derivatives over a box, and with second derivatives.
using BoxFirst = Dual<Interval, 2>;
using BoxSecond = Dual<BoxFirst, 2>;

/// A parameter that moves by (da, db) with the two coordinates.
[[nodiscard]] inline BoxSecond box_variable(const Interval& x, double da, double db) {
  BoxSecond s;
  s.v.v = x;
  s.v.d = {Interval(da), Interval(db)};
  s.d = {BoxFirst(da), BoxFirst(db)};
  return s;
}

/// (u, v) over the box |a| <= half_a, |b| <= half_b of a frame.
struct BoxParameters {
  BoxSecond u, v;
  BoxParameters(const PatchFrame& f, double half_a, double half_b) {
    const Interval a(-half_a, half_a), b(-half_b, half_b);
    const Vec2 &o = f.origin, &x = f.along_a, &y = f.along_b;
    u = box_variable(Interval(o[0]) + a * x[0] + b * y[0], x[0], y[0]);
    v = box_variable(Interval(o[1]) + a * x[1] + b * y[1], x[1], y[1]);
  }
};

[[nodiscard]] inline Interval square(const Interval& x) {
  const Interval s = x * x;
  return x.low >= 0 || x.high <= 0 ? s : Interval(0, s.high);
}

/// Second derivative along the direction (x, y).
[[nodiscard]] inline Interval along(const Interval& aa, const Interval& ab, const Interval& bb, const Interval& x,
                                    const Interval& y) {
  return aa * square(x) + Interval(2) * ab * x * y + bb * square(y);
}
[[nodiscard]] inline Interval along(const BoxSecond& f, const Interval& x, const Interval& y) {
  return along(f.d[0].d[0], f.d[0].d[1], f.d[1].d[1], x, y);
}

/// A piece over a box: place, first (a, b) and second derivatives (aa, ab, bb).
struct Jet {
  std::array<Interval, 3> place;
  std::array<std::array<Interval, 3>, 2> first;
  std::array<std::array<Interval, 3>, 3> second;

  void add(const Vec3T<BoxSecond>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const BoxSecond& c = p[int(k)];
      place[k] += c.v.v;
      first[0][k] += c.v.d[0];
      first[1][k] += c.v.d[1];
      second[0][k] += c.d[0].d[0];
      second[1][k] += c.d[0].d[1];
      second[2][k] += c.d[1].d[1];
    }
  }
};

/// Derivatives of a function over an interval.
struct CurveBend {
  Interval slope, bend;  ///< first and second
};

/// s or h of a chart over a box: first and second derivatives of  of_r radius + of_z z.
struct BoxCoordinate {
  std::array<Interval, 2> first;
  std::array<Interval, 3> second;

  BoxCoordinate(const Jet& p, double of_r, double of_z) {
    const Interval &x = p.place[0], &y = p.place[1];
    const auto sum = [&](const auto& r, const Interval& z) {
      return of_r == 0 ? Interval(of_z) * z : of_z == 0 && of_r == 1 ? r() : Interval(of_r) * r() + Interval(of_z) * z;
    };
    const Interval r = of_r == 0 ? Interval(0) : sqrt(square(x) + square(y));
    const auto slope = [&](std::size_t n) { return (x * p.first[n][0] + y * p.first[n][1]) / r; };
    const auto bend = [&](std::size_t n, std::size_t i, std::size_t j) {
      const Interval turn = p.first[i][0] * p.first[j][0] + p.first[i][1] * p.first[j][1] - slope(i) * slope(j);
      return (turn + x * p.second[n][0] + y * p.second[n][1]) / r;
    };
    for (std::size_t n = 0; n < 2; ++n) first[n] = sum([&] { return slope(n); }, p.first[n][2]);
    second[0] = sum([&] { return bend(0, 0, 0); }, p.second[0][2]);
    second[1] = sum([&] { return bend(1, 0, 1); }, p.second[1][2]);
    second[2] = sum([&] { return bend(2, 1, 1); }, p.second[2][2]);
  }
};

}  // namespace toothpath::tooth_space
