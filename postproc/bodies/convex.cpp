#include "postproc/bodies/convex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace toothpath::bodies {
namespace {

constexpr double kClose = 1e-6;       // mm, between the bounds
constexpr double kRounding = 1e-12;   // of the sizes that meet in a bound
constexpr double kAlongAxis = 1e-13;  // sine: any point of the rim will do
constexpr int kMostSteps = 200;

Vec3 farthest_of(const Box& b, const Vec3& d) {
  return b.centre +
         Vec3(std::copysign(b.half.x(), d.x()), std::copysign(b.half.y(), d.y()), std::copysign(b.half.z(), d.z()));
}
Vec3 farthest_of(const Cone& c, const Vec3& d) {
  const double along = d.dot(c.axis);
  Vec3 across = d - along * c.axis;
  across -= across.dot(c.axis) * c.axis;  // again: of a direction close to the axis rounding alone is left
  double out = across.norm();
  if (out < kAlongAxis * d.norm()) {
    across = c.axis.unitOrthogonal();
    out = 1;
  }
  const bool end = along * c.length + (c.radius_to - c.radius_from) * d.dot(across) / out > 0;
  const Vec3 centre = end ? Vec3(c.from + c.length * c.axis) : c.from;
  return centre + across * ((end ? c.radius_to : c.radius_from) / out);
}
Vec3 farthest_of(const Triangle& t, const Vec3& d) {
  const double a = t.corner[0].dot(d), b = t.corner[1].dot(d), c = t.corner[2].dot(d);
  return a >= b ? (a >= c ? t.corner[0] : t.corner[2]) : (b >= c ? t.corner[1] : t.corner[2]);
}

/// Corners of a simplex in the difference of the two bodies.
struct Simplex {
  std::array<Vec3, 4> at;
  int count = 0;
  void keep(std::initializer_list<int> which) {
    const std::array<Vec3, 4> old = at;
    count = 0;
    for (const int k : which) at[static_cast<std::size_t>(count++)] = old[static_cast<std::size_t>(k)];
  }
};

/// The place of a segment, a triangle or a tetrahedron that is nearest to the origin; corners that it does not need
/// leave the simplex. Every answer is a mean of corners with weights above 0, however thin the simplex is.
Vec3 nearest_on_segment(Simplex& s, int a, int b) {
  const Vec3 p = s.at[std::size_t(a)], q = s.at[std::size_t(b)], d = q - p;
  const double t = -p.dot(d), length = d.squaredNorm();
  if (t <= 0) {
    s.keep({a});
    return p;
  }
  if (t >= length) {
    s.keep({b});
    return q;
  }
  s.keep({a, b});
  return p + (t / length) * d;
}

Vec3 nearest_on_triangle(Simplex& s, int i, int j, int k) {
  const Vec3 a = s.at[std::size_t(i)], ab = s.at[std::size_t(j)] - a, ac = s.at[std::size_t(k)] - a;
  const double bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac), pb = -a.dot(ab), pc = -a.dot(ac);
  const double whole = bb * cc - bc * bc, u = pb * cc - pc * bc, v = pc * bb - pb * bc;
  const Simplex all = s;
  Simplex kept;
  Vec3 best = Vec3::Constant(std::numeric_limits<double>::infinity());
  const auto take = [&](const Vec3& p, const Simplex& on) {
    if (!(p.squaredNorm() < best.squaredNorm())) return;
    best = p;
    kept = on;
  };
  if (u > 0 && v > 0 && u + v < whole) {
    Simplex on = all;
    on.keep({i, j, k});
    take(a + (u / whole) * ab + (v / whole) * ac, on);
  }
  for (const auto& [from, to] : {std::pair(i, j), std::pair(i, k), std::pair(j, k)}) {
    Simplex on = all;
    const Vec3 p = nearest_on_segment(on, from, to);
    take(p, on);
  }
  s = kept;
  return best;
}

/// Nothing: the origin lies inside.
std::optional<Vec3> nearest_on_tetrahedron(Simplex& s) {
  static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  std::optional<Vec3> best;
  Simplex kept = s;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : kFaces) {
    const Vec3 &a = s.at[std::size_t(f[0])], &b = s.at[std::size_t(f[1])], &c = s.at[std::size_t(f[2])],
               &other = s.at[std::size_t(f[3])];
    const Vec3 n = (b - a).cross(c - a);
    const double origin = -n.dot(a), inner = n.dot(other - a);
    const bool flat = std::abs(inner) <= 1e-14 * n.norm() * (other - a).norm();
    if (!flat && (origin < 0) == (inner < 0) && origin != 0) continue;  // the origin lies on the inner side
    Simplex face = s;
    const Vec3 p = nearest_on_triangle(face, f[0], f[1], f[2]);
    if (p.squaredNorm() < least) {
      least = p.squaredNorm();
      best = p;
      kept = face;
    }
  }
  if (best) s = kept;
  return best;
}

}  // namespace

Vec3 farthest(const Convex& piece, const Vec3& direction) {
  return std::visit([&](const auto& p) { return farthest_of(p, direction); }, piece);
}

Vec3 middle(const Convex& piece) {
  if (const auto* box = std::get_if<Box>(&piece)) return box->centre;
  if (const auto* cone = std::get_if<Cone>(&piece)) return cone->from + 0.5 * cone->length * cone->axis;
  const Triangle& t = std::get<Triangle>(piece);
  return (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
}

Box box_of(const Convex& piece) {
  if (const auto* box = std::get_if<Box>(&piece)) return *box;
  Vec3 low, high;
  for (int k = 0; k < 3; ++k) {
    high[k] = farthest(piece, Vec3::Unit(k))[k];
    low[k] = farthest(piece, -Vec3::Unit(k))[k];
  }
  return {(low + high) / 2, (high - low) / 2};
}

Gap gap(const Convex& a, const Convex& b, const machines::Place& place, double enough) {
  const auto difference = [&](const Vec3& d) {
    return Vec3(farthest(a, d) - place.of(farthest(b, place.turn.transpose() * -d)));
  };
  Vec3 v = middle(a) - place.of(middle(b));
  if (v.squaredNorm() == 0) v = Vec3::UnitX();
  Simplex s;
  Gap out{0, std::numeric_limits<double>::infinity()};
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec3 w = difference(-v);
    const double length = v.norm();
    out.proven = std::max(out.proven, v.dot(w) / length - kRounding * (1 + w.norm() + place.shift.norm()));
    if (out.proven >= enough || out.measured - out.proven <= kClose) break;
    bool again = false;
    for (int k = 0; k < s.count; ++k) again = again || s.at[std::size_t(k)] == w;
    if (again) break;
    s.at[std::size_t(s.count++)] = w;
    Vec3 next = w;
    if (s.count == 2) next = nearest_on_segment(s, 0, 1);
    else if (s.count == 3) next = nearest_on_triangle(s, 0, 1, 2);
    else if (s.count == 4) {
      const auto found = nearest_on_tetrahedron(s);
      if (!found) return {0, 0};
      next = *found;
    }
    const double nearer = next.norm();
    if (!(nearer < out.measured)) break;  // rounding: no more to be had
    out.measured = nearer;
    v = next;
    if (nearer <= kRounding * (1 + w.norm())) return {0, 0};
  }
  return out;
}

}  // namespace toothpath::bodies
