// Numbers of the page's section 10, which were derived apart from this code.
#include "geometry/bevel_gear/limits.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

TEST(BevelWorkedValues, BlankOfW1) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  EXPECT_NEAR(degrees(g.delta()), 25.942295490, 5e-10);
  EXPECT_NEAR(g.R_e(), 123.438243669, 5e-10);
  EXPECT_NEAR(g.R_i(), 87.438243669, 5e-10);
  EXPECT_NEAR(g.R_0(), 164.584324892, 5e-10);
  EXPECT_NEAR(1 / g.kappa_v(), 80.068049947, 5e-10);
  EXPECT_NEAR(g.cutter().r_0, 2.356194490, 5e-10);
  EXPECT_NEAR(g.limits().module_at_small_end_mm, 3.098, 5e-4);
  EXPECT_NEAR(bevel_top_land(g, g.R_i()), 1.46, 5e-3);  // of the equivalent gear
}

TEST(BevelWorkedValues, TraceOfW1) {
  const bevel_gear::BevelTrace<double> t = made(w1(), pinion_mill()).halves()[0].walls[0].trace;
  const double rows[][5] = {{87.438243669, 43.207355143, -0.158130807, 3.392690775e-03, 239.924690717},
                            {100.0, 38.786881266, -0.041113701, 1.414583321e-03, 256.580844875},
                            {109.722883261, 35.264389683, 0.029002049, 0, 268.765077096},
                            {123.438243669, 30.0, 0.104753207, -2.025304254e-03, 285.068412842}};
  for (const auto& row : rows) {
    const double beta = t.beta(row[0]);
    EXPECT_NEAR(degrees(beta), row[1], 2e-9);
    EXPECT_NEAR(t.theta(beta), row[2], 6e-10);
    EXPECT_NEAR(t.kappa(beta), row[3], 1e-11);
    EXPECT_NEAR(t.arc(beta), row[4], 2e-9);
  }
}

TEST(BevelWorkedValues, EquidistantOfW1) {
  const bevel_gear::BevelTrace<double> t = made(w1(), pinion_mill()).halves()[0].walls[0].trace;
  const double beta = t.beta(100.0);
  const double rows[][6] = {{98.541136887, 0.018639080, -0.138641050, 0.996666967, 0.658319704, 0.017941203},
                            {101.492598971, 0.018096985, -0.048082855, 1.003333033, 0.695055770, 0.018781086}};
  for (int k = 0; k < 2; ++k) {
    const int sigma = k == 0 ? 1 : -1;
    const auto c = t.centre(sigma, beta);
    EXPECT_NEAR(c.R_c, rows[k][0], 6e-10);
    EXPECT_NEAR(t.theta_d(sigma, beta), rows[k][1], 6e-10);
    EXPECT_NEAR(c.e, rows[k][2], 6e-10);
    EXPECT_NEAR(t.speed_ratio(sigma, beta), rows[k][3], 6e-10);
    EXPECT_NEAR(c.beta_c, rows[k][4], 6e-10);
    EXPECT_NEAR(t.rate(c), rows[k][5], 6e-10);
  }
}

TEST(BevelWorkedValues, CutterOfW1) {
  const bevel_gear::FingerProfile<double> c = made(w1(), pinion_mill()).cutter();
  const double rows[][5] = {{-12.756935380, -3.280876453, 1.329325496, 12.557348940, -2.984775821},
                            {0, -0.034665836, 2.355854439, 21.686065791, 0.902178902},
                            {6, 2.034154213, 3.272613176, 25.979597073, 3.628871965},
                            {12.949090567, 4.8, 4.776878583, 30.952286694, 7.664826784}};
  EXPECT_NEAR(c.p_C, rows[0][0], 6e-10);
  EXPECT_NEAR(c.p_D, rows[3][0], 6e-10);
  for (const auto& row : rows) {
    const auto q = c.involute(row[0]);
    EXPECT_NEAR(q.x, row[1], 6e-10);
    EXPECT_NEAR(q.rho, row[2], 6e-10);
    EXPECT_NEAR(degrees(std::atan2(q.sin_psi, q.cos_psi)), row[3], 6e-10);
    EXPECT_NEAR(q.x + q.rho * q.sin_psi / q.cos_psi, row[4], 2e-9);
  }
  EXPECT_NEAR(c.x_B, -4.395675036, 6e-10);
  EXPECT_NEAR(c.rho_B, 1.081009665, 6e-10);
  EXPECT_NEAR(c.x_o, -4.2, 1e-12);
  EXPECT_NEAR(c.rho_o, 0.202538675, 6e-10);
  EXPECT_NEAR(largest_tip_radius(c), 1.153, 6e-4);
}

TEST(BevelWorkedValues, EnvelopeOfW1) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const double rows[][10] = {{43.039874148, -7.873969719, 89.937968327, 0.180785384, 0.711708714, -0.678813194,
                              38.237091585, 0.998767288, 0.00118381, -0.03996082},
                             {43.737103097, -0.306740710, 89.909686007, 0.560663367, -0.736121509, 0.379185592,
                              40.334852791, 0.999179147, -0.00130945, -0.04012582}};
  for (int k = 0; k < 2; ++k) {
    const auto& w = g.halves()[0].walls[k];
    const double beta = w.trace.beta(100.0);
    const auto f = w.point(beta, 0.0);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(f.p[i], rows[k][i], 6e-10);
      EXPECT_NEAR(f.n[i], rows[k][3 + i], 6e-10);
    }
    EXPECT_NEAR(degrees(f.gamma), rows[k][6], 6e-10);
    const auto curv = bevel_gear::bevel_curvature(w, beta, 0.0);
    EXPECT_NEAR(curv.regularity, rows[k][7], 6e-10);
    EXPECT_NEAR(curv.kappa_1, rows[k][8], 6e-9);
    EXPECT_NEAR(curv.kappa_2, rows[k][9], 6e-9);
  }
}

TEST(BevelWorkedValues, WallsOfW1ByHeight) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const double where[][2] = {{90, 0}, {105, 0}, {120, 0}, {90, 3}, {105, -3}};
  const double azimuth[][5] = {{-0.387677384, -0.094410531, 0.113866983, -0.430477615, -0.069783655},
                               {-0.213136826, 0.080126649, 0.288402248, -0.170801832, 0.055207385}};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 5; ++i) {
      const auto at = bevel_gear::bevel_inverse(g.halves()[0].walls[k], where[i][0], where[i][1]);
      ASSERT_TRUE(at);
      EXPECT_NEAR(at->azimuth, azimuth[k][i], 6e-10) << k << ' ' << i;
      EXPECT_LE(at->iterations, 9);
    }
}

TEST(BevelWorkedValues, HerringboneCornerOfW3) {
  const bevel_gear::BevelGear g = made(w3(), pinion_mill());
  const auto& X = g.corner();
  const auto& t = g.halves()[0].wall(X.sigma).trace;
  EXPECT_EQ(X.sigma, -1);
  EXPECT_NEAR(degrees(t.beta(104.0)), 37.352470924, 6e-10);
  EXPECT_NEAR(t.R(X.beta_inner), 102.577163660, 6e-10);
  EXPECT_NEAR(t.R(X.beta_outer), 105.435437408, 6e-10);
  EXPECT_NEAR(X.R_c, 104.040025056, 6e-10);
  EXPECT_NEAR(X.e, 0.022136276, 6e-10);
  EXPECT_NEAR(t.rate(t.centre(-1, X.beta_inner)), 0.01772, 6e-6);
  const auto& outer = g.halves()[1].wall(-1).trace;
  EXPECT_NEAR(outer.rate(outer.centre(-1, X.beta_outer)), -0.01584, 6e-6);
  const double azimuth[2][2] = {{-0.254793407, -0.209998415}, {-0.080254207, -0.035462257}};
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(bevel_gear::bevel_inverse(g.halves()[0].walls[k], 95, 0)->azimuth, azimuth[k][0], 6e-10);
    EXPECT_NEAR(bevel_gear::bevel_inverse(g.halves()[1].walls[k], 112, 0)->azimuth, azimuth[k][1], 6e-10);
  }
  // Reach of the corner fillet: +-0.83 at height -3.1, +-1.50 at 0, +-2.94 at h_a.
  const auto& w = g.halves()[0].wall(-1);
  EXPECT_NEAR(bevel_gear::contact_reach(w, X.beta_inner, -3.1), 0.83, 0.01);
  EXPECT_NEAR(bevel_gear::contact_reach(w, X.beta_inner, 0), 1.50, 0.03);
  EXPECT_NEAR(g.limits().fillet_reach_mm, 2.94, 0.01);
}

TEST(BevelWorkedValues, WheelsAreMade) {
  made(w2(), wheel_mill());
  made(w4(), wheel_mill());
}

}  // namespace
}  // namespace toothpath
