#include "cam/clearance/frustum_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toothpath::clearance {
namespace {

constexpr int kMostSteps = 200;
constexpr double kMeet = 1e-10;  // mm
constexpr double kFlat = 1e-9;   // a flatter tetrahedron holds nothing

/// A corner of the simplex: point of the difference set (frustum - triangle), and the point of the triangle in it.
struct Corner {
  Vec3 difference = Vec3::Zero(), on_triangle = Vec3::Zero();
};

/// Up to four corners with the weights of the point of their hull that is nearest to the origin.
struct Simplex {
  std::array<Corner, 4> corner;
  std::array<double, 4> weight{};
  int count = 0;
};

/// Nearest point to the origin of the hull of some corners of a simplex, as weights; `n` corners named by `which`.
struct Nearest {
  Vec3 point = Vec3::Zero();
  double squared = INFINITY;
  std::array<int, 3> which{};
  std::array<double, 3> weight{};
  int count = 0;
};

void take(Nearest& best, const Simplex& s, std::array<int, 3> which, std::array<double, 3> weight, int count) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < count; ++k) p += weight[std::size_t(k)] * s.corner[std::size_t(which[std::size_t(k)])].difference;
  const double d = p.squaredNorm();
  if (d < best.squared) best = {p, d, which, weight, count};
}

void on_edge(Nearest& best, const Simplex& s, int i, int j) {
  const Vec3 &a = s.corner[std::size_t(i)].difference, &b = s.corner[std::size_t(j)].difference;
  const Vec3 ab = b - a;
  const double l = ab.squaredNorm();
  const double t = l > 0 ? -a.dot(ab) / l : 0;
  if (t > 0 && t < 1) take(best, s, {i, j, 0}, {1 - t, t, 0}, 2);
}

void on_face(Nearest& best, const Simplex& s, int i, int j, int k) {
  const Vec3 &a = s.corner[std::size_t(i)].difference, &b = s.corner[std::size_t(j)].difference,
             &c = s.corner[std::size_t(k)].difference;
  const Vec3 u = b - a, w = c - a, n = u.cross(w);
  const double det = n.squaredNorm();
  if (!(det > 0)) return;
  const double v = -w.cross(n).dot(a) / det, z = -n.cross(u).dot(a) / det;
  if (v > 0 && z > 0 && v + z < 1) take(best, s, {i, j, k}, {1 - v - z, v, z}, 3);
}

bool holds_origin(const Simplex& s) {
  if (s.count < 4) return false;
  const auto side = [&](int i, int j, int k, int l) {
    const Vec3& a = s.corner[std::size_t(i)].difference;
    const Vec3 n = (s.corner[std::size_t(j)].difference - a).cross(s.corner[std::size_t(k)].difference - a);
    const Vec3 edge = s.corner[std::size_t(l)].difference - a;
    const double corner = n.dot(edge), origin = -n.dot(a);
    return corner * origin > 0 && std::abs(corner) > kFlat * n.norm() * edge.norm();
  };
  return side(0, 1, 2, 3) && side(0, 1, 3, 2) && side(0, 2, 3, 1) && side(1, 2, 3, 0);
}

/// Keeps of the simplex what holds the point nearest to the origin, and returns that point.
Vec3 reduce(Simplex& s) {
  Nearest best{};
  for (int i = 0; i < s.count; ++i) take(best, s, {i, 0, 0}, {1, 0, 0}, 1);
  for (int i = 0; i < s.count; ++i)
    for (int j = i + 1; j < s.count; ++j) on_edge(best, s, i, j);
  for (int i = 0; i < s.count; ++i)
    for (int j = i + 1; j < s.count; ++j)
      for (int k = j + 1; k < s.count; ++k) on_face(best, s, i, j, k);
  const std::array<Corner, 4> all = s.corner;
  s.count = best.count;
  for (std::size_t k = 0; k < std::size_t(best.count); ++k) {
    s.corner[k] = all[std::size_t(best.which[k])];
    s.weight[k] = best.weight[k];
  }
  return best.point;
}

/// Point of the frustum that lies farthest along d.
Vec3 farthest_of(const tool::Frustum& f, const Vec3& tip, const Vec3& axis, const Vec3& d) {
  const double along = d.dot(axis);
  const Vec3 across = d - along * axis;
  const double l = across.norm();
  const bool upper = f.to * along + f.radius_to * l > f.from * along + f.radius_from * l;
  const Vec3 middle = tip + (upper ? f.to : f.from) * axis;
  if (!(l > 0)) return middle;
  // Along the axis, `across` is rounding: made square to the axis again, it is still a point of the rim.
  Vec3 u = across / l;
  u -= u.dot(axis) * axis;
  if (u.norm() < 0.5) u = axis.unitOrthogonal();
  return middle + (upper ? f.radius_to : f.radius_from) * u.normalized();
}

Vec3 farthest_of(const TriangleCorners& t, const Vec3& d) {
  const double a = t.a.dot(d), b = t.b.dot(d), c = t.c.dot(d);
  return a >= b && a >= c ? t.a : b >= c ? t.b : t.c;
}

}  // namespace

FrustumGap frustum_to_triangle(const tool::Frustum& body, const Vec3& tip, const Vec3& axis, const TriangleCorners& t,
                               double enough) {
  FrustumGap gap;
  Simplex s;
  const Vec3 middle = tip + 0.5 * (body.from + body.to) * axis;
  const Vec3 start = nearest_on_triangle(middle, t);
  const Vec3 first = farthest_of(body, tip, axis, start - middle);
  s.corner[0] = {first - start, start};
  s.weight[0] = 1;
  s.count = 1;
  Vec3 v = s.corner[0].difference;
  gap.above = v.norm();
  gap.foot = start;
  for (; gap.steps < kMostSteps; ++gap.steps) {
    if (gap.above <= kMeet) {
      gap.distance = 0;
      return gap;
    }
    const Vec3 on_body = farthest_of(body, tip, axis, -v), on_triangle = farthest_of(t, v);
    const Vec3 w = on_body - on_triangle;
    gap.distance = std::max(gap.distance, v.dot(w) / v.norm());
    if (gap.distance >= enough || gap.above - gap.distance <= kMeet) break;
    bool known = false;
    for (int k = 0; k < s.count; ++k) known = known || s.corner[std::size_t(k)].difference == w;
    if (known) break;
    s.corner[std::size_t(s.count++)] = {w, on_triangle};
    if (gap.distance <= 0 && holds_origin(s)) {
      gap.distance = gap.above = 0;
      return gap;
    }
    const Vec3 next = reduce(s);
    if (!(next.squaredNorm() < v.squaredNorm())) break;  // rounding: no nearer point to be found
    v = next;
    gap.above = v.norm();
    gap.foot = Vec3::Zero();
    for (int k = 0; k < s.count; ++k) gap.foot += s.weight[std::size_t(k)] * s.corner[std::size_t(k)].on_triangle;
  }
  return gap;
}

}  // namespace toothpath::clearance
