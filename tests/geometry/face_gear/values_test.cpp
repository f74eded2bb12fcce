// The worked values of docs/face_gear.md, to their printed digits.
#include <gtest/gtest.h>

#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

struct WorkedPoint {
  int side;
  double theta, B, Z, phi;
  Vec3 p, n;
};

void expect_points(const face_gear::FaceGearSurface<double>& f, const std::vector<WorkedPoint>& points) {
  for (const auto& w : points) {
    const auto q = f.flank(w.side, w.theta, w.B);
    EXPECT_NEAR(f.flank_Z(w.side, w.theta, w.B), w.Z, 2e-12);
    EXPECT_NEAR(f.flank_phi(w.side, w.theta, w.B), w.phi, 1e-12);
    EXPECT_LT((q.p - w.p).norm(), 3e-12);
    EXPECT_LT((q.n - w.n).norm(), 3e-14);
  }
}

TEST(FaceGearValues, OffsetGearFlank) {
  expect_points(case_named("offset_15").surface(), {{1,
                                                     0.35,
                                                     0.5,
                                                     141.342172611715,
                                                     0.102072530796,
                                                     {141.893667852951, 16.963682680772, -36.837648068764},
                                                     {0.02544446582943, 0.87721361827820, 0.47942553860420}},
                                                    {-1,
                                                     0.35,
                                                     -0.5,
                                                     141.342172611715,
                                                     -0.102072530796,
                                                     {141.023853424052, 13.023705049060, -36.837648068764},
                                                     {0.02544446582943, -0.87721361827820, 0.47942553860420}},
                                                    {1,
                                                     0.20,
                                                     0.4,
                                                     134.670154041233,
                                                     0.152072530796,
                                                     {135.504636942544, 16.394140430328, -35.201284795930},
                                                     {0.03977968999384, 0.92020157081890, 0.38941834230865}}});
}

TEST(FaceGearValues, HelicalFlankTransverse) {
  expect_points(case_named("dhfg_transverse").surface(), {{1,
                                                           0.35,
                                                           0.5,
                                                           474.342496900417,
                                                           -0.074844122202,
                                                           {474.154147861527, 18.057039244960, -73.675296137529},
                                                           {-0.48645571851157, 0.76536329560410, 0.42140225399186}},
                                                          {-1,
                                                           0.35,
                                                           -0.5,
                                                           489.354134543093,
                                                           -0.415492775270,
                                                           {489.021370227441, 21.748027270500, -73.675296137529},
                                                           {0.52910190311099, -0.73652652121625, 0.42140225399186}},
                                                          {-1,
                                                           0.20,
                                                           -0.4,
                                                           467.621515770003,
                                                           -0.298194997952,
                                                           {467.762588909645, 8.786388255017, -70.402569591860},
                                                           {0.51650143514878, -0.78489806109564, 0.34228833047235}}});
}

TEST(FaceGearValues, HelicalFlankNormal) {
  const auto f = case_named("dhfg_normal").surface();
  EXPECT_NEAR(f.L0, 519.615242271, 5e-10);
  expect_points(f, {{1,
                     0.35,
                     0.5,
                     537.508509525371,
                     0.000765185489,
                     {537.510259194302, 13.685292445583, -83.461278426611},
                     {-0.46974751035492, 0.77474437031784, 0.42321204753193}},
                    {-1,
                     0.35,
                     -0.5,
                     554.191925930693,
                     -0.350564858254,
                     {554.049398227141, 18.631243843963, -83.461278426611},
                     {0.51428167425074, -0.74592621776801, 0.42321204753193}}});
}

TEST(FaceGearValues, Curvature) {
  const auto o = case_named("offset_15").surface();
  EXPECT_NEAR(o.flank_J(1, 0.35, 0.5), 5492.23644363, 6e-9);
  const auto H = o.flank_shape(1, 0.35, 0.5);
  EXPECT_NEAR(H.ee, -0.003836431637, 6e-13);
  EXPECT_NEAR(H.el, -0.012337969774, 6e-13);
  EXPECT_NEAR(H.ll, 0.001970715298, 6e-13);
  EXPECT_NEAR(H.k1(), 0.011742165973, 6e-13);
  EXPECT_NEAR(H.k2(), -0.013607882312, 6e-13);
  const auto d = case_named("dhfg_transverse").surface();
  EXPECT_NEAR(d.flank_J(1, 0.35, 0.5), 45703.37957599, 6e-9);
  const auto K = d.flank_shape(1, 0.35, 0.5);
  EXPECT_NEAR(K.ee, 0.002505265859, 6e-13);
  EXPECT_NEAR(K.el, -0.004250222713, 6e-13);
  EXPECT_NEAR(K.ll, 0.000473647003, 6e-13);
  EXPECT_NEAR(K.k1(), 0.005859383422, 6e-13);
  EXPECT_NEAR(K.k2(), -0.002880470560, 6e-13);
}

TEST(FaceGearValues, SharpFillet) {
  const auto o = case_named("offset_15").surface().fillet(1, 1.066100192329, 135.96);
  EXPECT_NEAR(o.B, 0.907499889123, 1.5e-12);
  EXPECT_LT((o.p - Vec3(135.237049587, 19.097902035, -41.200864195)).norm(), 1e-9);
  EXPECT_LT((o.n - Vec3(-0.027732946645, 0.615092790114, 0.787966841447)).norm(), 2e-12);
  const auto d = case_named("dhfg_transverse").surface().fillet(1, 1.031102549238, 463.5);
  EXPECT_NEAR(d.B, 0.899079718481, 1.5e-12);
  EXPECT_LT((d.p - Vec3(463.274939754, 14.834816904, -81.179251682)).norm(), 1e-9);
  EXPECT_LT((d.n - Vec3(-0.368443552633, 0.569904145229, 0.734478463792)).norm(), 2e-12);
}

/// Shaper dimensions of both samples.
TEST(FaceGearValues, Shaper) {
  const auto o = case_named("offset_15").surface();
  EXPECT_NEAR(o.shaper.r_b, 35.238473, 5e-7);
  EXPECT_NEAR(o.shaper.theta_0, 0.0479274692, 5e-11);
  EXPECT_NEAR(o.shaper.theta_t, 0.6085178231, 5e-11);
  EXPECT_NEAR(o.M2, 124.039426, 5e-7);
  EXPECT_NEAR(o.z_tip(140.0), -34.5, 1e-13);
  const auto t = case_named("dhfg_transverse").surface();
  EXPECT_NEAR(t.shaper.r_b, 70.476947, 5e-7);
  EXPECT_NEAR(degrees(t.shaper.beta_b), 28.481238, 5e-7);
  EXPECT_NEAR(1 / t.shaper.kappa, 129.903811, 5e-7);
  EXPECT_NEAR(t.M2, 371.684131, 5e-7);
  const auto n = case_named("dhfg_normal").surface();
  EXPECT_NEAR(n.shaper.m_t, 5.773503, 5e-7);
  EXPECT_NEAR(degrees(n.shaper.alpha_t), 22.795877, 5e-7);
  EXPECT_NEAR(n.shaper.r_a, 92.852540, 5e-7);
  EXPECT_NEAR(degrees(n.shaper.beta_b), 28.024321, 5e-7);
  EXPECT_NEAR(1 / n.shaper.kappa, 150, 1e-9);
  EXPECT_NEAR(n.M2, 422.861679, 5e-7);
}

/// Angle at which the helix folds the papers' parametrisation: dZ/d(phi) at constant phi vanishes, (3.4).
TEST(FaceGearValues, FoldOfTheOtherParametrisation) {
  const auto fold_deg = [](const face_gear::FaceGearSurface<double>& f) {
    const double kappa = f.shaper.kappa, T = f.shaper.T, D = f.shaper.r_b * (1 / f.i + f.Cg);
    const auto F = [&](double x) {
      return f.Sg * (1 - x * x) + kappa * ((f.Sg * T * f.shaper.r_b - f.E * f.Cg) - (D - f.Sg * T * f.E) * x);
    };
    double lo = -1, hi = 1;  // F(-1) and F(1) differ in sign for every helical case
    for (int k = 0; k < 100; ++k) ((F(0.5 * (lo + hi)) > 0) == (F(lo) > 0) ? lo : hi) = 0.5 * (lo + hi);
    return degrees(std::asin(lo));
  };
  EXPECT_NEAR(fold_deg(case_named("dhfg_transverse").surface()), 20.990, 5e-4);
  EXPECT_NEAR(fold_deg(case_named("dhfg_normal").surface()), 21.163, 5e-4);
  EXPECT_NEAR(fold_deg(case_named("beta_45").surface()), 21.82, 5e-3);
  EXPECT_NEAR(fold_deg(case_named("gamma_110_mixed").surface()), -37.39, 5e-3);
  // On the fold the closed form is as regular as anywhere.
  const auto f = case_named("dhfg_transverse").surface();
  const double B = radians(20.990);
  EXPECT_GT(f.flank_J(1, 0.4, B), 0);
  const auto P = f.flank(1, 0.4, B), Q = f.flank(1, 0.4, B + 1e-6);
  EXPECT_LT((P.p - Q.p).norm(), 1e-3);
}

}  // namespace
}  // namespace toothpath::test
