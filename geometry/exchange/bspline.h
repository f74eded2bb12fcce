// Clamped cubic B-splines over [0, 1], simple inner knots: values, and the spline through given places.
//
// Interpolation is at the Greville points. The first and last control point are then the first and last place itself,
// so patches that are given the same places along a common edge have the same control points there.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::exchange {

inline constexpr int kDegree = 3;

/// Where the pieces of a spline join: increasing, from 0 to 1.
using Breaks = std::vector<double>;

/// 0, 1/n .. 1.
[[nodiscard]] Breaks even_breaks(std::size_t pieces);
/// Full knot vector, the ends four times.
[[nodiscard]] std::vector<double> clamped_knots(const Breaks& breaks);
[[nodiscard]] inline std::size_t control_count(const Breaks& breaks) { return breaks.size() - 1 + kDegree; }
/// One parameter a control point: means of three successive knots.
[[nodiscard]] std::vector<double> greville_points(const Breaks& breaks);

/// The four basis functions that do not vanish at t in [0, 1], and the control point of the first.
struct BasisAt {
  std::size_t first = 0;
  std::array<double, kDegree + 1> value{};
};
[[nodiscard]] BasisAt basis_at(const std::vector<double>& knots, double t);

/// A curve.
struct SplineCurve {
  Breaks breaks;
  std::vector<Vec3> control;

  [[nodiscard]] Vec3 at(double t) const;
};
/// The curve through one place a Greville point.
[[nodiscard]] SplineCurve curve_through(const Breaks& breaks, const std::vector<Vec3>& places);

/// A surface; control[i * control_count(v) + j], i along u.
struct SplineSurface {
  Breaks u, v;
  std::vector<Vec3> control;

  [[nodiscard]] std::size_t columns() const { return control_count(v); }
  [[nodiscard]] const Vec3& point(std::size_t i, std::size_t j) const { return control[i * columns() + j]; }
  [[nodiscard]] Vec3 at(double s, double t) const;
};
/// The surface through the places over all pairs of Greville points, in the order of the control points.
[[nodiscard]] SplineSurface surface_through(const Breaks& u, const Breaks& v, const std::vector<Vec3>& places);

}  // namespace toothpath::exchange
