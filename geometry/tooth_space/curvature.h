// Curvatures of a piece from its first derivatives.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// 1/mm, convex positive.
struct PrincipalCurvatures {
  double least = 0, most = 0;
};

[[nodiscard]] inline PrincipalCurvatures principal_curvatures(const PatchPoint& at) {
  const double E = at.pu.squaredNorm(), F = at.pu.dot(at.pv), G = at.pv.squaredNorm();
  const double L = at.nu.dot(at.pu), M = 0.5 * (at.nu.dot(at.pv) + at.nv.dot(at.pu)), N = at.nv.dot(at.pv);
  // Roots of k^2 (EG - FF) - k (LG - 2MF + NE) + (LN - MM).
  const double area = E * G - F * F, half = 0.5 * (L * G - 2 * M * F + N * E) / area, product = (L * N - M * M) / area;
  const double apart = std::sqrt(std::max(0.0, half * half - product));
  return {half - apart, half + apart};
}

/// Of the normal section along a direction of any length, 1/mm, convex positive.
[[nodiscard]] inline double normal_curvature(const PatchPoint& at, const Vec3& along) {
  const Vec3 t = along - at.n * at.n.dot(along);
  const double uu = at.pu.squaredNorm(), uv = at.pu.dot(at.pv), vv = at.pv.squaredNorm();
  const double tu = t.dot(at.pu), tv = t.dot(at.pv), det = uu * vv - uv * uv;
  const double a = (tu * vv - tv * uv) / det, b = (tv * uu - tu * uv) / det;
  return (at.nu * a + at.nv * b).dot(t) / t.squaredNorm();
}

}  // namespace toothpath::tooth_space
