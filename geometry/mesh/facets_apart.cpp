#include "geometry/mesh/facets_apart.h"

#include <cmath>
#include <limits>

namespace toothpath::mesh {
namespace {

// Rounding of the determinants below, as parts of the sums of their absolute terms: J. R. Shewchuk, Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates (1997), errboundA of orient2d and orient3d.
constexpr double kHalfEps = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double kLineError = (3 + 16 * kHalfEps) * kHalfEps, kPlaneError = (7 + 56 * kHalfEps) * kHalfEps;

/// -1, 1, or 0 where rounding, or terms too small for it, may hide the sign.
int sure_sign(double value, double error) {
  if (!(std::abs(value) > error + std::numeric_limits<double>::min())) return 0;
  return value > 0 ? 1 : -1;
}

/// Side of the plane through a, b, c on which p lies.
int plane_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 u = a - p, v = b - p, w = c - p;
  const double vw = v.x() * w.y(), wv = w.x() * v.y(), wu = w.x() * u.y(), uw = u.x() * w.y(), uv = u.x() * v.y(),
               vu = v.x() * u.y();
  const double value = u.z() * (vw - wv) + v.z() * (wu - uw) + w.z() * (uv - vu);
  const double terms = (std::abs(vw) + std::abs(wv)) * std::abs(u.z()) +
                       (std::abs(wu) + std::abs(uw)) * std::abs(v.z()) +
                       (std::abs(uv) + std::abs(vu)) * std::abs(w.z());
  return sure_sign(value, kPlaneError * terms);
}

/// Side of the line through a and b on which p lies, as seen along the axis that is neither x nor y.
int line_side(const Vec3& a, const Vec3& b, const Vec3& p, int x, int y) {
  const double left = (a[x] - p[x]) * (b[y] - p[y]), right = (a[y] - p[y]) * (b[x] - p[x]);
  return sure_sign(left - right, kLineError * (std::abs(left) + std::abs(right)));
}

/// A facet by its corners, and which of them the other one has, too.
struct Facet {
  std::array<const Vec3*, 3> corner;
  std::array<bool, 3> shared{};
};

/// Does one side of something hold all corners of the facet that are not shared? 0: not surely.
template <typename Side>
int common_side(const Facet& facet, const Side& side) {
  int common = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (facet.shared[k]) continue;
    const int own = side(*facet.corner[k]);
    if (own == 0 || own == -common) return 0;
    common = own;
  }
  return common;
}

bool plane_parts(const Facet& a, const Facet& b) {
  return common_side(b, [&](const Vec3& p) { return plane_side(*a.corner[0], *a.corner[1], *a.corner[2], p); }) != 0;
}

/// Shared corners lie on the line itself; the rest of `a` is its third corner.
bool line_parts(const Facet& a, const Facet& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t third = (k + 2) % 3;
    if (a.shared[third]) continue;
    const Vec3 &from = *a.corner[k], &to = *a.corner[(k + 1) % 3];
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, own = line_side(from, to, *a.corner[third], x, y);
      if (own != 0 && common_side(b, [&](const Vec3& p) { return line_side(from, to, p, x, y); }) == -own) return true;
    }
  }
  return false;
}

}  // namespace

bool surely_apart(const std::vector<Vec3>& points, const std::array<std::size_t, 3>& a,
                  const std::array<std::size_t, 3>& b) {
  Facet one{{&points[a[0]], &points[a[1]], &points[a[2]]}}, other{{&points[b[0]], &points[b[1]], &points[b[2]]}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (a[i] == b[k]) one.shared[i] = other.shared[k] = true;
  return plane_parts(one, other) || plane_parts(other, one) || line_parts(one, other) || line_parts(other, one);
}

}  // namespace toothpath::mesh
