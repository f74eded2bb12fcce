#include "cam/line/contact.h"

#include "geometry/base/dual.h"

namespace toothpath::line {
namespace {

using Along = Dual<double, 1>;  // value and derivative along the axis

/// The same surface in another scalar.
face_gear::FaceGearSurface<Along> with_slopes(const face_gear::FaceGearSurface<double>& f) {
  face_gear::FaceGearSurface<Along> g;
  const auto& w = f.shaper;
  g.shaper = {w.teeth, w.m_t,     w.alpha_t, w.r_p, w.r_b,     w.r_a, w.kappa, w.beta_b, w.sin_bb, w.cos_bb,
              w.T,     w.theta_0, w.rho,     w.r_c, w.theta_t, w.A_t, w.A_e,   w.psi_c,  w.h_a,    w.h_f};
  g.i = f.i;
  g.E = f.E;
  g.Sg = f.Sg;
  g.Cg = f.Cg;
  g.L0 = f.L0;
  g.L_p = f.L_p;
  g.M2 = f.M2;
  g.pitch = f.pitch;
  return g;
}

}  // namespace

std::optional<double> distance_third(const face_gear::FaceGearSurface<double>& f, int side,
                                     const AxisLine<double>& axis, double t, const Place<double>& start) {
  const auto near = flank_foot<double>(f, side, axis.at(t), start);
  if (!near) return {};
  const Vec3 x = axis.at(t);
  Vec3T<Along> moving, a;
  for (int k = 0; k < 3; ++k) {
    moving[k].v = x[k];
    moving[k].d[0] = axis.a[k];
    a[k] = Along(axis.a[k]);
  }
  const auto g = with_slopes(f);
  const auto foot = flank_foot<Along>(g, side, moving, {Along(near->at.theta), Along(near->at.B)});
  if (!foot) return {};
  return distance_bend<Along>(g, side, *foot, a).d[0];
}

}  // namespace toothpath::line
