// Identities of the flank and fillet in 50 digits, where only a wrong formula can be off, and how close double comes.
#include <gtest/gtest.h>

#include <boost/multiprecision/eigen.hpp>

#include "tests/support/face_gear_cases.h"
#include "tests/support/fifty_digits.h"

namespace toothpath::test {
namespace {

using Vec = Vec3T<F50>;

double as_double(const F50& x) { return static_cast<double>(x); }
double size(const Vec& v) { return as_double(F50(sqrt(F50(v.squaredNorm())))); }

struct Exact {
  FaceGearCase c;
  face_gear::FaceGearSurface<double> near;
  face_gear::FaceGearSurface<F50> f;
  std::vector<FlankSample> samples;
};

/// A few gears of each kind with flank samples, made once.
const std::vector<Exact>& gears() {
  static const std::vector<Exact> all = [] {
    std::vector<Exact> list;
    std::vector<FaceGearCase> cases;
    for (const char* name :
         {"spur_25_88", "offset_15", "dhfg_transverse", "dhfg_normal", "gamma_75_mixed", "gamma_110_mixed", "beta_45"})
      cases.push_back(case_named(name));
    for (const auto& c : random_cases(31337, 5)) cases.push_back(c);
    for (auto& c : cases) {
      Exact e;
      e.c = c;
      e.near = c.surface();
      e.f = c.surface<F50>();
      e.samples = trimmed_flank(e.near, c.module_mm, 3, 3);
      list.push_back(std::move(e));
    }
    return list;
  }();
  return all;
}

/// Calls check(gear, side, theta, B) on every sample.
template <typename Check>
void on_every_flank(Check check) {
  for (const auto& g : gears()) {
    SCOPED_TRACE(g.c.name);
    ASSERT_FALSE(g.samples.empty());
    for (const auto& at : g.samples) check(g, at.side, F50(at.theta), F50(at.B));
  }
}

/// T1. The contact normal meets the relative motion at a right angle, checked from velocities and not from (3.1).
TEST(FaceGearExact, NormalIsPerpendicularToTheRelativeMotion) {
  on_every_flank([](const Exact& g, int s, const F50& th, const F50& B) {
    const auto& f = g.f;
    const Vec P = f.flank_housing(s, th, B), n = (f.t(B) * f.shaper.cos_bb - f.a() * f.shaper.sin_bb) * F50(s);
    const Vec relative = f.a().cross(Vec(P - f.b() * f.E)) - Vec(0, 0, 1).cross(P) * f.i;
    EXPECT_LT(std::abs(as_double(n.dot(relative))), 1e-44 * g.near.L_p);
  });
}

/// T2. Constant moment of the normal about the gear axis.
TEST(FaceGearExact, MomentOfTheNormalIsConstant) {
  on_every_flank([](const Exact& g, int s, const F50& th, const F50& B) {
    const auto q = g.f.flank(s, th, B);
    EXPECT_LT(std::abs(as_double(q.p[0] * q.n[1] - q.p[1] * q.n[0] - F50(s) * g.f.M2)), 1e-44 * g.near.M2);
    EXPECT_LT(std::abs(as_double(q.n.squaredNorm()) - 1), 1e-15);
    EXPECT_GT(s * as_double(q.p[0] * q.n[1] - q.p[1] * q.n[0]), 0);  // outward on its own side
  });
}

/// T3. First derivatives against central differences; their cross product is along the normal; (4.2).
TEST(FaceGearExact, DerivativesAndNormal) {
  const F50 h("1e-14");
  on_every_flank([&](const Exact& g, int s, const F50& th, const F50& B) {
    const auto& f = g.f;
    const auto d = f.flank_derivatives(s, th, B);
    const Vec u = (f.flank(s, F50(th + h), B).p - f.flank(s, F50(th - h), B).p) / F50(2 * h);
    const Vec v = (f.flank(s, th, F50(B + h)).p - f.flank(s, th, F50(B - h)).p) / F50(2 * h);
    EXPECT_LT(size(Vec(d.u - u)), 1e-23 * size(u));
    EXPECT_LT(size(Vec(d.v - v)), 1e-23 * size(v));
    const auto q = f.flank(s, th, B);
    Vec cross = d.u.cross(d.v);
    EXPECT_LT(size(Vec(cross.cross(q.n))), 1e-40 * size(cross));
    const F50 r = sqrt(F50(q.p[0] * q.p[0] + q.p[1] * q.p[1]));
    const auto dr = [&](const Vec& w) { return F50((q.p[0] * w[0] + q.p[1] * w[1]) / r); };
    const F50 det = dr(d.u) * d.v[2] - dr(d.v) * d.u[2];
    const F50 printed = F50(s) * f.shaper.r_b * f.flank_J(s, th, B) / (f.shaper.cos_bb * r);
    EXPECT_LT(std::abs(as_double((det - printed) / printed)), 1e-38);
  });
}

/// T5. Parallel surfaces are rotations.
TEST(FaceGearExact, ParallelSurfaceIsARotation) {
  on_every_flank([](const Exact& g, int s, const F50& th, const F50& B) {
    const auto& f = g.f;
    const auto q = f.flank(s, th, B);
    for (const double share : {-0.1, 0.1, 0.37}) {
      const F50 delta = F50(share) * F50(g.c.module_mm);
      const auto shifted = f.flank(s, F50(th - delta * f.shaper.cos_bb / f.shaper.r_b), B);
      const Vec turned = toothpath::turned(shifted.p, F50(F50(s) * delta / f.M2));
      EXPECT_LT(size(Vec(turned - q.p - q.n * delta)), 1e-44 * g.near.L_p);
    }
  });
}

/// T6. Flank -s of (E, beta) is the mirror image of flank s of (-E, -beta). The fillet as well.
TEST(FaceGearExact, MirrorIdentity) {
  for (const auto& g : gears()) {
    auto c = g.c;
    c.offset_mm = -c.offset_mm;
    c.beta_deg = -c.beta_deg;
    const auto m = c.surface<F50>();
    for (const auto& at : g.samples) {
      const auto p = g.f.flank(at.side, F50(at.theta), F50(at.B)), q = m.flank(-at.side, F50(at.theta), F50(-at.B));
      EXPECT_LT(size(Vec(p.p - Vec(q.p[0], -q.p[1], q.p[2]))), 1e-44 * g.near.L_p);
      EXPECT_LT(size(Vec(p.n - Vec(q.n[0], -q.n[1], q.n[2]))), 1e-44);
      const F50 A = g.f.shaper.A_t + F50(0.1), Z = g.f.flank_Z(at.side, F50(at.theta), F50(at.B));
      const auto a = g.f.fillet(at.side, A, Z), b = m.fillet(-at.side, A, Z);
      EXPECT_LT(size(Vec(a.p - Vec(b.p[0], -b.p[1], b.p[2]))), 1e-44 * g.near.L_p);
    }
  }
}

/// T7. Another reference section only turns the gear.
TEST(FaceGearExact, ReferenceSectionTurnsTheGear) {
  on_every_flank([](const Exact& g, int s, const F50& th, const F50& B) {
    auto moved = g.f;
    const F50 D = F50(7.25) * F50(g.c.module_mm);
    moved.L0 += D;
    const auto p = g.f.flank(s, th, B), q = moved.flank(s, th, B);
    EXPECT_LT(size(Vec(q.p - toothpath::turned(p.p, F50(-g.f.i * g.f.shaper.kappa * D)))), 1e-44 * g.near.L_p);
  });
}

/// T10. Shape operator: dn = H dP by differences, and the closed form of the Gauss curvature.
TEST(FaceGearExact, FlankShapeOperator) {
  const F50 h("1e-14");
  on_every_flank([&](const Exact& g, int s, const F50& th, const F50& B) {
    const auto& f = g.f;
    const auto H = f.flank_shape(s, th, B);
    const auto basis = f.flank_basis(s, th, B);
    const auto q = f.flank(s, th, B);
    EXPECT_LT(std::abs(as_double(basis.e.dot(q.n))) + std::abs(as_double(basis.l.dot(q.n))), 1e-44);
    for (const int direction : {0, 1}) {
      const F50 dth = direction == 0 ? h : F50(0), dB = direction == 0 ? F50(0) : h;
      const auto a = f.flank(s, F50(th + dth), F50(B + dB)), b = f.flank(s, F50(th - dth), F50(B - dB));
      const Vec dP = (a.p - b.p) / F50(2 * h), dn = (a.n - b.n) / F50(2 * h);
      const F50 pe = dP.dot(basis.e), pl = dP.dot(basis.l);
      const double scale = 1e-22 * (size(dn) + 1);
      EXPECT_LT(std::abs(as_double(dn.dot(basis.e) - (H.ee * pe + H.el * pl))), scale);
      EXPECT_LT(std::abs(as_double(dn.dot(basis.l) - (H.el * pe + H.ll * pl))), scale);
    }
    const F50 K = -f.Sg * f.shaper.cos_bb * cos(B) / f.flank_J(s, th, B);
    EXPECT_LT(std::abs(as_double((K - H.gauss()) / K)), 1e-40);
    EXPECT_LT(as_double(K), 0);  // a saddle everywhere
    EXPECT_LT(as_double(abs(F50(H.k1() * H.k2() - K)) / abs(K)), 1e-40);
    EXPECT_GT(as_double(H.k1()), 0);
    EXPECT_LT(as_double(H.k2()), 0);
  });
}

/// The fillet: normal by differences of the position, shape operator by differences of the normal.
TEST(FaceGearExact, FilletNormalAndShapeOperator) {
  const F50 h("1e-14");
  for (const auto& g : gears()) {
    SCOPED_TRACE(g.c.name);
    auto c = g.c;
    c.tip_radius_mm = 0.5 * largest_tip_radius(c.parameters(), c.beta());
    const auto f = c.surface<F50>();
    const auto limits = face_gear::zone_limits(c.surface(), c.module_mm);
    for (const double t : {0.15, 0.6, 0.95}) {
      const double r = limits.inner_limit * (1 - t) + *limits.land_radius * t;
      const F50 Z = (sqrt(F50(r * r) - f.E * f.E) + f.shaper.r_a * f.Cg) / f.Sg;
      for (const int s : {1, -1}) {
        for (const double u : {0.1, 0.5, 0.9}) {
          const F50 A = f.shaper.A_t + F50(u) * (f.shaper.A_e - f.shaper.A_t);
          const auto q = f.fillet(s, A, Z);
          ASSERT_TRUE(q.defined);
          const auto H = f.fillet_shape(s, A, Z);
          const auto basis = f.fillet_basis(s, A, Z);
          for (const int direction : {0, 1}) {
            const F50 dA = direction == 0 ? h : F50(0), dZ = direction == 0 ? F50(0) : h;
            const auto a = f.fillet(s, F50(A + dA), F50(Z + dZ)), b = f.fillet(s, F50(A - dA), F50(Z - dZ));
            const Vec dP = (a.p - b.p) / F50(2 * h), dn = (a.n - b.n) / F50(2 * h);
            EXPECT_LT(std::abs(as_double(dP.dot(q.n))), 1e-20 * (1 + size(dP)));
            const F50 pe = dP.dot(basis.e), pl = dP.dot(basis.l);
            const double scale = 1e-18 * (size(dn) + 1);
            EXPECT_LT(std::abs(as_double(dn.dot(basis.e) - (H.ee * pe + H.el * pl))), scale);
            EXPECT_LT(std::abs(as_double(dn.dot(basis.l) - (H.el * pe + H.ll * pl))), scale);
          }
        }
      }
    }
  }
}

/// T12. Flank, fillet and root meet in the same points with the same normals; (A, Z) is another chart of the flank.
TEST(FaceGearExact, PatchesJoinSmoothly) {
  for (const auto& g : gears()) {
    SCOPED_TRACE(g.c.name);
    for (const double share : {0.0, 0.5}) {
      auto c = g.c;
      c.tip_radius_mm = share * largest_tip_radius(c.parameters(), c.beta());
      const auto f = c.surface<F50>();
      for (const auto& at : g.samples) {
        if (at.side * at.B < 0.35) continue;  // on the sheet of (5.1)
        const F50 B(at.B), th = f.shaper.theta_t, Z = f.flank_Z(at.side, th, B);
        const auto flank = f.flank(at.side, th, B);
        const auto fillet = f.fillet(at.side, f.shaper.A_t, Z);
        EXPECT_LT(size(Vec(flank.p - fillet.p)), 1e-42 * g.near.L_p);
        EXPECT_LT(size(Vec(flank.n - fillet.n)), 1e-42);
        const auto again = f.flank_by_A(at.side, F50(at.theta), f.flank_Z(at.side, F50(at.theta), B));
        EXPECT_LT(size(Vec(again.p - f.flank(at.side, F50(at.theta), B).p)), 1e-42 * g.near.L_p);
        const auto end = f.fillet(at.side, f.shaper.A_e, Z);
        auto root = f.root_meridian(Z);
        const F50 turn = atan2(end.p[1], end.p[0]) - atan2(root.p[1], root.p[0]);
        EXPECT_LT(size(Vec(toothpath::turned(root.p, turn) - end.p)), 1e-42 * g.near.L_p);
        EXPECT_LT(size(Vec(toothpath::turned(root.n, turn) - end.n)), 1e-42);
        if (g.c.gamma_deg == 90) {
          EXPECT_LT(std::abs(as_double(end.p[2] + f.shaper.r_a)), 1e-44 * g.near.L_p);
          EXPECT_NEAR(as_double(end.n[2]), 1, 1e-15);
        }
      }
    }
  }
}

/// Positions in double are good to a few units in the last place of the radius.
TEST(FaceGearExact, DoubleIsGoodToRounding) {
  double worst_p = 0, worst_n = 0, worst_H = 0;
  on_every_flank([&](const Exact& g, int s, const F50& th, const F50& B) {
    const auto q = g.f.flank(s, th, B);
    const auto d = g.near.flank(s, as_double(th), as_double(B));
    worst_p = std::max(worst_p, size(Vec(q.p - d.p.cast<F50>())) / g.near.L_p);
    worst_n = std::max(worst_n, size(Vec(q.n - d.n.cast<F50>())));
    const auto H = g.f.flank_shape(s, th, B);
    const auto K = g.near.flank_shape(s, as_double(th), as_double(B));
    worst_H = std::max(worst_H, std::abs(as_double((H.k2() - F50(K.k2())) / H.k2())));
  });
  EXPECT_LT(worst_p, 20 * 2.2e-16);
  EXPECT_LT(worst_n, 20 * 2.2e-16);
  EXPECT_LT(worst_H, 1e-11);
  RecordProperty("position_error_over_L_p", std::to_string(worst_p * 1e16) + "e-16");
}

/// T8, T9. Spur, zero offset and right angle are ordinary points: differences fall linearly to 0.
TEST(FaceGearExact, LimitsOfHelixOffsetAndShaftAngleAreOrdinary) {
  const auto spread = [](const FaceGearCase& a, const FaceGearCase& b) {
    const auto f = a.surface<F50>(), g = b.surface<F50>();
    double worst = 0;
    for (const int s : {1, -1})
      for (const double th : {0.1, 0.35, 0.6})
        for (const double B : {0.15, 0.5, 0.8}) {
          worst = std::max(worst, size(Vec(f.flank(s, F50(th), F50(s * B)).p - g.flank(s, F50(th), F50(s * B)).p)));
          const F50 A = f.shaper.A_t + F50(0.2);
          worst = std::max(
              worst, size(Vec(f.fillet(s, A, F50(f.L_p * F50(1.05))).p - g.fillet(s, A, F50(f.L_p * F50(1.05))).p)));
        }
    return worst;
  };
  for (const int what : {0, 1, 2}) {
    double before = 0;
    for (const double small : {1e-3, 1e-6, 1e-9, 1e-12}) {
      auto base = case_named("offset_15"), near = base;
      base.offset_mm = near.offset_mm = what == 1 ? 0 : 15;
      (what == 0 ? near.beta_deg : what == 1 ? near.offset_mm : near.gamma_deg) += small;
      const double difference = spread(near, base);
      EXPECT_GT(difference, 0);
      if (before > 0) {
        EXPECT_NEAR(before / difference, 1000, what == 2 && small < 1e-10 ? 20 : 5)
            << "quantity " << what << " at " << small;
      }
      before = difference;
    }
  }
}

/// T11. With ever more gear teeth the flank becomes the rack's plane.
TEST(FaceGearExact, ManyTeethMakeARack) {
  auto c = case_named("dhfg_transverse");
  double before_B = 0;
  for (const int teeth : {18000, 1800000, 180000000}) {
    c.teeth = teeth;
    const auto f = c.surface<F50>();
    const F50 th(0.4), Z = f.L_p + F50(10);
    const auto q = f.flank_by_A(1, th, Z);
    ASSERT_TRUE(q.defined);
    const auto H = f.flank_shape(1, th, q.B);
    const double off = std::abs(as_double(q.B - f.shaper.alpha_t));
    if (before_B > 0) { EXPECT_NEAR(before_B / off, 100, 1); }
    before_B = off;
    if (teeth == 180000000) {
      EXPECT_NEAR(as_double(H.ee * F50(teeth)), 1.2492, 6e-5);
      EXPECT_NEAR(as_double(H.el * F50(teeth)), -1.0990, 6e-5);
      EXPECT_LT(std::abs(as_double(H.ll)), 1e-6);
      const Vec rack = f.t(f.shaper.alpha_t) * f.shaper.cos_bb - f.a() * f.shaper.sin_bb;
      const Vec n = toothpath::turned(q.n, F50(f.i * f.flank_phi(1, th, q.B)));
      EXPECT_LT(size(Vec(n - rack)), 1e-6);
    }
  }
}

/// T17. On the pitch plane at the pitch point tooth and space of a spur gear without offset share the pitch evenly.
TEST(FaceGearExact, ToothIsHalfAPitchAtThePitchPoint) {
  for (const char* name : {"spur_25_88", "gamma_60", "gamma_120", "few_teeth", "sixty_teeth"}) {
    const auto f = case_named(name).surface<F50>();
    F50 azimuth[2];
    for (const int k : {0, 1}) {
      const int s = k == 0 ? 1 : -1;
      const F50 B = F50(s) * f.shaper.alpha_t, th = tan(f.shaper.alpha_t);
      const Vec P = f.flank_housing(s, th, B);
      EXPECT_LT(std::abs(as_double(f.flank_Z(s, th, B) - f.L_p)), 1e-40);
      azimuth[k] = atan2(P[1], P[0]) - f.i * f.flank_phi(s, th, B);
    }
    EXPECT_LT(std::abs(as_double(azimuth[0] - azimuth[1] - f.pitch / F50(2))), 1e-44) << name;
  }
}

/// T14. A pinion of fewer teeth on parallel axis, aligned: contact at B = s alpha_t, common normal, no transmission
/// error.
TEST(FaceGearExact, AlignedPinionTouchesWithoutTransmissionError) {
  for (const auto& g : gears()) {
    SCOPED_TRACE(g.c.name);
    const auto& f = g.f;
    const F50 alpha = f.shaper.alpha_t, pi = f.pitch * F50(g.c.teeth) / F50(2);
    for (int N_p = g.c.shaper_teeth - 3; N_p < g.c.shaper_teeth; ++N_p) {
      const F50 r_p1 = f.shaper.m_t * F50(N_p) / F50(2), r_b1 = r_p1 * cos(alpha);
      const F50 kappa1 = f.shaper.kappa * f.shaper.r_p / r_p1;
      const F50 theta_01 = pi / F50(2 * N_p) - (tan(alpha) - alpha);
      for (const int s : {1, -1}) {
        for (const double roll : {0.2, 0.36, 0.5}) {
          const F50 th(roll), B = F50(s) * alpha, Z = f.flank_Z(s, th, B);
          const F50 th1 = tan(alpha) + (th - tan(alpha)) * f.shaper.r_b / r_b1;
          const F50 phi1 = B - F50(s) * (theta_01 + th1) - kappa1 * (Z - f.L0);
          const Vec on_pinion =
              f.b() * f.E + f.d() * F50(f.shaper.r_p - r_p1) + f.a() * Z + (f.e(B) - f.t(B) * F50(F50(s) * th1)) * r_b1;
          EXPECT_LT(size(Vec(on_pinion - f.flank_housing(s, th, B))), 1e-43 * g.near.L_p);
          // Gear angle minus its nominal angle: the same for all points of the path.
          const F50 phi2 = f.i * f.flank_phi(s, th, B);
          EXPECT_LT(std::abs(as_double(phi2 - phi1 * F50(N_p) / F50(g.c.teeth))), 1e-44);
        }
      }
    }
  }
}

}  // namespace
}  // namespace toothpath::test
