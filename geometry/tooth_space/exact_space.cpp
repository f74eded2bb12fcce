#include "geometry/tooth_space/exact_space.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::tooth_space {
namespace {

constexpr int kSteps = 30;

}  // namespace

PatchPoint patch_of(const Vec3T<Second>& p, const Vec3& towards) {
  const auto of = [&](const auto& take) { return Vec3(take(p[0]), take(p[1]), take(p[2])); };
  PatchPoint q;
  q.p = of([](const Second& x) { return x.v.v; });
  q.pu = of([](const Second& x) { return x.v.d[0]; });
  q.pv = of([](const Second& x) { return x.v.d[1]; });
  const Vec3 across = q.pu.cross(q.pv);
  const double size = across.norm();
  q.n = towards;
  if (!(size > 0)) return q;
  const double scale = (across.dot(towards) > 0 ? 1 : -1) / size;
  q.n = across * scale;
  const Vec3 uu = of([](const Second&x) { return x.d[0].d[0]; }), uv = of([](const Second&x) { return x.d[0].d[1]; }),
             vv = of([](const Second&x) { return x.d[1].d[1]; });
  const auto tangential = [&](const Vec3& change) { return Vec3((change - q.n * q.n.dot(change)) * scale); };
  q.nu = tangential(uu.cross(q.pv) + q.pu.cross(uv));
  q.nv = tangential(uv.cross(q.pv) + q.pu.cross(vv));
  return q;
}

std::optional<PatchFoot> search_foot(const ToothSpace& space, Piece piece, const Vec3& c, double u, double v,
                                     const Vec2& most) {
  PatchFoot f{u, v, 0, {}};
  double before = INFINITY;
  for (int k = 0; k < kSteps; ++k) {
    const auto q = space.at(piece, f.u, f.v);
    if (!q) return {};
    if (k == 0) f.distance = (c - q->p).dot(q->n);
    const Vec3 lack = c - q->p - q->n * f.distance;
    const double error = lack.norm();
    f.at = *q;
    if (error < 2e-13 * (1 + c.norm()) || (error < 1e-11 && error >= 0.5 * before)) {
      f.distance = (c - q->p).dot(q->n);
      return f;
    }
    before = error;
    Mat3 J;
    J << q->pu + q->nu * f.distance, q->pv + q->nv * f.distance, q->n;
    Vec3 step = J.inverse() * lack;
    if (!step.allFinite()) return {};
    step /= std::max({1.0, std::abs(step[0]) / most[0], std::abs(step[1]) / most[1]});
    f.u += step[0];
    f.v += step[1];
    f.distance += step[2];
  }
  return {};
}

std::optional<PiecePlace> search_place(const ToothSpace& space, Piece piece, double s, double h, const Vec2& start) {
  const Chart& c = space.outline().chart;
  Vec2 x = start;
  for (int k = 0; k < kSteps; ++k) {
    const auto q = space.at(piece, x[0], x[1]);
    if (!q) return {};
    const double lack_s = s - c.along(q->p), lack_h = h - c.up(q->p);
    if (std::abs(lack_s) + std::abs(lack_h) < 1e-12 * q->p.norm()) return PiecePlace{x[0], x[1], *q};
    const double su = c.along(q->p, q->pu), sv = c.along(q->p, q->pv), hu = c.up(q->p, q->pu), hv = c.up(q->p, q->pv),
                 det = su * hv - sv * hu;
    if (det == 0) return {};
    x += Vec2(lack_s * hv - sv * lack_h, su * lack_h - lack_s * hu) / det;
  }
  return {};
}

std::optional<EdgePlace> search_tip_edge(const ToothSpace& space, int side, double s, const Vec2& start,
                                         const std::optional<EdgePlace>& near) {
  const auto found = search_place(space, flank_of(side), s, space.tip(s), start);
  if (!found) return {};
  // Of the flank's own tooth: the minus flank of the space belongs to the next one.
  const double own = azimuth(turned(found->at.p, side > 0 ? 0.0 : -space.outline().pitch));
  return EdgePlace{found->u, found->v, near ? near->azimuth + std::remainder(own - near->azimuth, kTwoPi) : own};
}

}  // namespace toothpath::tooth_space
