// Facts that hold for every gear (section 9 of the page) and the extreme cases (section 11).
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <map>
#include <random>

#include "geometry/bevel_gear/limits.h"
#include "geometry/bevel_gear/part.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using Wide = boost::multiprecision::cpp_bin_float_50;

std::vector<bevel_gear::BevelGear> some_gears() {
  return {made(w1(), pinion_mill()),
          made(w2(), wheel_mill()),
          gear_of(design(12, 60, 3, 45, 0.25)),
          gear_of(design(25, 25, 5, 5, 0.22, -1)),
          gear_of(design(44, 31, 2, 20, 0.3)),
          gear_of(design(30, 0, 4, 35, 0.25, 1, 90))};
}

TEST(BevelInvariants, EquidistantIsAParallelOfTheTrace) {
  for (const auto& g : some_gears())
    for (int k = 0; k < 2; ++k) {
      const auto& w = g.halves()[0].walls[k];
      const auto& t = w.trace;
      for (const double R : {g.R_i(), g.R_m(), 0.999 * g.R_e()}) {
        const double beta = t.beta(R), theta = t.theta(beta) - w.sigma * t.e_h * t.sin_delta;
        const auto c = t.curved_centre(w.sigma, beta);
        const double d = c.theta_c - theta;
        EXPECT_NEAR(std::hypot(c.R_c * std::cos(d) - R, c.R_c * std::sin(d)), t.r_0, 1e-12 * t.R_0);
        // F and A against differences.
        const double h = 1e-6;
        const auto a = t.curved_centre(w.sigma, beta - h), b = t.curved_centre(w.sigma, beta + h);
        const double ds = t.arc(beta + h) - t.arc(beta - h), turn = b.theta_c - a.theta_c;
        const double along = (b.R_c - a.R_c) * std::cos(c.beta_c) + c.R_c * turn * std::sin(c.beta_c);
        EXPECT_NEAR(along / ds, t.speed_ratio(w.sigma, beta), 1e-6);
        EXPECT_NEAR((b.e - a.e) / (b.R_c - a.R_c) / t.rate(c), 1, 1e-6);
      }
    }
}

// The contact moves only inside the surface: velocity of cutter material against the blank has no part along the
// normal.
TEST(BevelInvariants, NoVelocityAlongTheNormal) {
  for (const auto& g : some_gears())
    for (int k = 0; k < 2; ++k) {
      const auto& w = g.halves()[0].walls[k];
      const auto& t = w.trace;
      for (const double share : {0.02, 0.2, 0.5, 0.8, 1.0}) {
        const double beta = t.beta(g.R_m()), p = w.cutter.p_A + share * (w.cutter.p_D - w.cutter.p_A);
        const auto c = t.centre(w.sigma, beta);
        const auto f = w.point(beta, p);
        const auto q = w.cutter.at(p);
        const double A = t.rate(c), x = f.contact.x(), y = f.contact.y(), z = f.contact.z();
        const Vec3 v(-A * t.cos_delta * y, A * (t.cos_delta * x + t.sin_delta * (z + c.R_c)), 1 - A * t.sin_delta * y);
        const Vec3 n(-q.sin_psi, q.cos_psi * y / q.rho, q.cos_psi * z / q.rho);
        EXPECT_NEAR(n.dot(v) / v.norm(), 0, 1e-13);
      }
    }
}

TEST(BevelInvariants, ScaleAndMirror) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  for (const double s : {1e-3, 1e3}) {
    auto p = w1();
    for (double* v : {&p.outer_transverse_module_mm, &p.face_width_mm, &p.addendum_mm, &p.dedendum_mm}) *v *= s;
    const auto m = pinion_mill();
    const bevel_gear::BevelGear big =
        made(p, {m.module_mm * s, m.tip_radius_mm * s, m.rack_depth_mm * s, m.profile_height_mm * s});
    for (int k = 0; k < 2; ++k) {
      const Vec3 a = g.halves()[0].walls[k].point(0.6, 2.0).p, b = big.halves()[0].walls[k].point(0.6, 2.0 * s).p;
      EXPECT_LT((b / s - a).norm(), 1e-12 * g.R_0());
    }
  }
  auto left = w1();
  left.hand = -1;
  const bevel_gear::BevelGear mirror = made(left, pinion_mill());
  for (int k = 0; k < 2; ++k) {
    const auto a = g.halves()[0].walls[k].point(0.6, 2.0), b = mirror.halves()[0].walls[1 - k].point(0.6, 2.0);
    EXPECT_LT((a.p - Vec3(b.p.x(), -b.p.y(), b.p.z())).norm(), 1e-12 * g.R_0());
    EXPECT_LT((a.n - Vec3(b.n.x(), -b.n.y(), b.n.z())).norm(), 1e-12);
  }
}

// delta = 90 deg: the cutter is a cone, the wall at height x the parallel of the trace at distance r_0 - rho(x).
TEST(BevelInvariants, CrownWheelWallsAreParallelCurves) {
  const bevel_gear::BevelGear g = gear_of(design(30, 0, 4, 35, 0.25, 1, 90));
  for (int k = 0; k < 2; ++k) {
    const auto& w = g.halves()[0].walls[k];
    for (const double p : {-3.0, 0.0, 3.0}) {
      const double beta = w.trace.beta(g.R_m());
      const auto f = w.point(beta, p);
      const auto c = w.trace.centre(w.sigma, beta);
      // Flat: the point lies on the normal of the centre path at distance rho.
      const double d = std::remainder(std::atan2(f.p.y(), f.p.x()) - c.theta_c, 2 * kPi),
                   R = std::hypot(f.p.x(), f.p.y());
      const double along = (R * std::cos(d) - c.R_c) * std::cos(c.beta_c) + R * std::sin(d) * std::sin(c.beta_c);
      const double across = R * std::sin(d) * std::cos(c.beta_c) - (R * std::cos(d) - c.R_c) * std::sin(c.beta_c);
      EXPECT_NEAR(along, 0, 1e-12 * g.R_0());
      EXPECT_NEAR(-w.sigma * across, w.cutter.at(p).rho, 1e-12 * g.R_0());
    }
  }
}

// Brute force: every wall point has zero clearance to its own pass and none below zero to the other; independent of the
// equation of meshing.
TEST(BevelInvariants, WallsAreTheBoundaryOfWhatTheMovingCutterRemoves) {
  for (const auto& g : some_gears()) {
    const bevel_gear::FingerSolid solid(g.cutter());
    const auto& half = g.halves()[0];
    for (int k = 0; k < 2; ++k) {
      const auto& w = half.walls[k];
      for (const double u : {0.0, 0.5, 1.0})
        for (const double v : {0.1, 0.35, 0.6, 0.9}) {
          const double ell = half.ell_from + (half.ell_to - half.ell_from) * u;
          const double height =
              -g.parameters().dedendum_mm + (g.parameters().addendum_mm + g.parameters().dedendum_mm) * v;
          const auto at = bevel_gear::bevel_inverse(w, ell, height);
          ASSERT_TRUE(at);
          const Vec3 p = w.point(at->beta, at->p).p;
          EXPECT_NEAR(clearance_of_pass(p, w.trace, w.sigma, half.beta_from[k], half.beta_to[k], solid), 0, 1e-9);
          EXPECT_GE(clearance_of_pass(p, w.trace, -w.sigma, half.beta_from[1 - k], half.beta_to[1 - k], solid), -1e-9);
        }
    }
  }
}

TEST(BevelInvariants, GapBetweenTheWallsOnThePitchCone) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  for (const double ell : {90.0, 105.0, 120.0}) {
    const auto L = bevel_gear::bevel_inverse(g.halves()[0].walls[0], ell, 0),
               U = bevel_gear::bevel_inverse(g.halves()[0].walls[1], ell, 0);
    EXPECT_NEAR(U->azimuth - L->azimuth, 2 * g.e_h(), 1.5e-3 / (ell * g.sin_delta()));
  }
}

TEST(BevelInvariants, CurvatureIsSymmetricAndTheNormalFollowsTheSurface) {
  for (const auto& g : some_gears())
    for (int k = 0; k < 2; ++k) {
      const auto& w = g.halves()[0].walls[k];
      const double beta = w.trace.beta(g.R_m()), h = 1e-6;
      for (const double p : {0.3 * w.cutter.p_C, 0.0, 0.5 * w.cutter.p_D}) {
        const auto c = bevel_gear::bevel_curvature(w, beta, p);
        EXPECT_LT(c.asymmetry, 1e-13);
        EXPECT_GT(c.regularity, 0.5);
        const Vec3 du = w.point(beta + h, p).p - w.point(beta - h, p).p,
                   dv = w.point(beta, p + h).p - w.point(beta, p - h).p;
        EXPECT_NEAR(w.point(beta, p).n.dot(du.cross(dv).normalized()),
                    w.sigma * (du.cross(dv).dot(w.point(beta, p).n) * w.sigma > 0 ? 1 : -1), 1e-6);
        // Mean curvature from differences of the normal along the surface.
        const Vec3 nu = w.point(beta + h, p).n - w.point(beta - h, p).n,
                   nv = w.point(beta, p + h).n - w.point(beta, p - h).n;
        const double E = du.dot(du), F = du.dot(dv), G = dv.dot(dv), L = du.dot(nu),
                     M = 0.5 * (du.dot(nv) + dv.dot(nu)), N = dv.dot(nv);
        EXPECT_NEAR(std::abs((E * N - 2 * F * M + G * L) / (E * G - F * F)), std::abs(c.kappa_1 + c.kappa_2), 1e-5);
      }
    }
}

TEST(BevelInvariants, CutterModuleHardlyChangesTheFlank) {
  const bevel_gear::BevelGear a = made(w1(), pinion_mill());
  const bevel_gear::BevelGear b = made(w1(), {2.4, 0.5, 4.1, 4.8});
  double worst = 0;
  for (int k = 0; k < 2; ++k)
    for (const double ell : {88.0, 100.0, 123.0})
      for (const double height : {-2.5, 0.0, 4.0}) {
        const auto p = bevel_gear::bevel_inverse(a.halves()[0].walls[k], ell, height),
                   q = bevel_gear::bevel_inverse(b.halves()[0].walls[k], ell, height);
        worst = std::max(worst, std::abs(p->azimuth - q->azimuth) * (ell * a.sin_delta() + height * a.cos_delta()));
      }
  EXPECT_GT(worst, 1e-5);
  EXPECT_LT(worst, 8e-3);
}

// The same text with 50 digits.
TEST(BevelInvariants, DoubleAgreesWithFiftyDigits) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const auto& w = g.halves()[0].walls[0];
  bevel_gear::BevelWall<Wide> wide;
  auto& t = wide.trace;
  t.R_0 = w.trace.R_0, t.sin_delta = w.trace.sin_delta, t.cos_delta = w.trace.cos_delta, t.beta_ref = w.trace.beta_ref;
  t.r_0 = w.trace.r_0, t.e_h = w.trace.e_h, t.h = w.trace.h;
  wide.sigma = w.sigma;
  wide.cutter = bevel_gear::make_finger_profile<Wide>(Wide(w.cutter.alpha_n), Wide(g.kappa_v()), Wide(5.1), Wide(3.0),
                                                      Wide(0.9), Wide(4.1), Wide(4.8));
  t.r_0 = wide.cutter.r_0;
  std::mt19937 random(42);
  std::uniform_real_distribution<double> betas(0.02, 1.2), shares(0.02, 1.0);
  for (int n = 0; n < 200; ++n) {
    const double beta = betas(random), p = w.cutter.p_C + shares(random) * (w.cutter.p_D - w.cutter.p_C);
    const auto exact = wide.point(Wide(beta), Wide(p));
    const auto f = w.point(beta, p);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(f.p[i], static_cast<double>(exact.p[i]), 1e-14 * g.R_0() * 8);
  }
}

TEST(BevelExtremes, EndOfTheTrace) {
  const bevel_gear::BevelTrace<double> t = made(w1(), pinion_mill()).halves()[0].walls[0].trace;
  EXPECT_EQ(t.beta(t.R_0), 0.0);
  EXPECT_EQ(t.beta(std::nextafter(t.R_0, 1e9)), 0.0);
  EXPECT_TRUE(std::isinf(t.speed_ratio(-1, 0.0)) && t.speed_ratio(-1, 0.0) < 0);
  EXPECT_TRUE(std::isinf(t.speed_ratio(1, 0.0)) && t.speed_ratio(1, 0.0) > 0);
  EXPECT_NEAR(t.curved_centre(-1, 0.0).R_c, std::hypot(t.R_0, t.r_0), 1e-12);
  EXPECT_NEAR(t.theta_d(-1, 0.0), std::atan(t.r_0 / t.R_0), 1e-15);
  EXPECT_NEAR(degrees(t.beta(1e-6 * t.R_0)), 89.9427, 1e-4);
  EXPECT_TRUE(std::isfinite(t.theta(t.beta(1e-6 * t.R_0))));
  EXPECT_NEAR(t.kappa(t.beta(2 * t.R_0 / 3)), 0, 1e-15);
  EXPECT_NEAR(t.speed_ratio(1, t.beta(2 * t.R_0 / 3)), 1, 1e-15);
}

TEST(BevelExtremes, StraightAtTheLargeEnd) {
  const bevel_gear::BevelGear g = gear_of(design(25, 25, 5, 0, 20 / 88.388));
  EXPECT_EQ(g.halves()[0].walls[0].trace.beta(g.R_e()), 0.0);
  EXPECT_GT(g.limits().cusp_loss_mm, 0);
  EXPECT_LT(g.limits().cusp_loss_mm, 1e-3);
  EXPECT_GT(g.limits().least_regularity, 0);
  EXPECT_GT(g.halves()[0].ell_to, g.R_e() - 0.15);
  for (int k = 0; k < 2; ++k)
    for (const double height : {-2.0, 0.0, 2.0})
      EXPECT_TRUE(bevel_gear::bevel_inverse(g.halves()[0].walls[k], g.halves()[0].ell_to, height));
  const bevel_gear::BevelPart part(g);
  const auto mesh = mesh::mesh_gear(drawn_solid(part));
  EXPECT_TRUE(mesh) << mesh.error().message;
}

// Near beta_e = 0 the straight end of the path has a short parameter; the walls still have every profile point at both
// ends of the face.
TEST(BevelExtremes, SmallSpiralAnglesHaveTheirWholeWalls) {
  for (const double beta_deg : {2.0, 3.0, 5.0, 10.0}) {
    const bevel_gear::BevelGear g = gear_of(design(7, 0, 6.0, beta_deg, 0.18, 1, 15));
    for (const auto& wall : g.halves()[0].walls)
      for (const double ell : {g.R_i(), g.halves()[0].ell_to})
        for (int k = 0; k <= 20; ++k) {
          const double p = wall.cutter.p_A + (wall.cutter.p_C - wall.cutter.p_A) * k / 20;
          const auto beta = bevel_gear::bevel_beta_at(wall, ell, p);
          ASSERT_TRUE(beta) << beta_deg << " deg, wall " << wall.sigma << ", ell " << ell << ", p " << p;
          EXPECT_NEAR(wall.generatrix(*beta, p)[0], ell, 1e-9 * g.R_0()) << beta_deg;
        }
    const bevel_gear::BevelPart part(g);
    const auto mesh = mesh::mesh_gear(drawn_solid(part));
    EXPECT_TRUE(mesh) << beta_deg << ": " << mesh.error().message;
  }
}

// At the tip of the convex wall the cone distance turns back near the end of a trace of small spiral angle: three
// places have the same. The last one is found, on the branch of the rest of the wall.
TEST(BevelExtremes, WhereTheConeDistanceTurnsBackTheBranchOfTheWallIsFound) {
  auto p = w1();
  p.outer_spiral_angle_rad = radians(3);
  const bevel_gear::BevelGear g = made(p, pinion_mill());
  const auto& wall = g.halves()[0].wall(1);
  ASSERT_LT(wall.eps(), 0);
  const double ell = g.halves()[0].ell_to, tip = wall.cutter.p_A;
  const auto beyond = [&](double beta) { return wall.generatrix(beta, tip)[0] - ell; };
  std::vector<double> turns;
  for (int k = 1; k < 400; ++k)
    if ((beyond(0.001 * k) > 0) != (beyond(0.001 * (k - 1)) > 0)) turns.push_back(0.001 * k);
  ASSERT_EQ(turns.size(), 3u);
  const auto found = bevel_gear::bevel_beta_at(wall, ell, tip);
  ASSERT_TRUE(found);
  double low = turns[2] - 0.001, high = turns[2];
  for (int k = 0; k < 60; ++k) (beyond((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  EXPECT_NEAR(*found, low, 1e-12);
}

TEST(BevelExtremes, AlmostACrownWheelAndAlmostACylinder) {
  const bevel_gear::BevelGear flat = gear_of(design(30, 0, 4, 35, 0.25, 1, 90)),
                              nearly = gear_of(design(30, 0, 4, 35, 0.25, 1, 89.9999));
  EXPECT_LT((flat.halves()[0].walls[0].point(0.7, 1.0).p - nearly.halves()[0].walls[0].point(0.7, 1.0).p).norm(), 1e-3);
  const bevel_gear::BevelGear slim = gear_of(design(20, 0, 3, 30, 1e-4, 1, 0.01));
  EXPECT_GT(slim.R_e(), 1.7e5);
  const auto& w = slim.halves()[0].walls[0];
  const auto f = w.point(w.trace.beta(slim.R_m()), 0.0);
  EXPECT_NEAR(clearance_of_pass(f.p, w.trace, 1, slim.halves()[0].beta_from[0], slim.halves()[0].beta_to[0],
                                bevel_gear::FingerSolid(w.cutter), 4000),
              0, 1e-7);
}

TEST(BevelExtremes, FewTeethClipPointC) {
  const bevel_gear::BevelGear g = gear_of(design(7, 40, 4, 30, 0.2));
  EXPECT_TRUE(g.cutter().base_circle_clips_C);
  EXPECT_FALSE(g.warnings().empty());
}

void expect_refused(const bevel_gear::BevelGearParameters& p, const bevel_gear::FingerCutterData& c,
                    const std::string& key, const std::string& part) {
  const auto g = bevel_gear::BevelGear::make(p, c);
  ASSERT_TRUE(!g.has_value()) << key;
  for (const auto& r : g.error())
    if (r.key == key && r.diagnostic.message.find(part) != std::string::npos) return;
  for (const auto& r : g.error()) ADD_FAILURE() << r.key << ": " << r.diagnostic.message;
}

TEST(BevelRefusals, NameValueAndLimit) {
  auto p = w3();
  expect_refused(p, {3.098, 0.9, 4.1, 4.8}, "tool.module", "3.0669");
  expect_refused(p, {3.2, 0.9, 4.1, 4.8}, "tool.module", "160.5 um");
  expect_refused(p, {3.0, 1.2, 4.1, 4.8}, "tool.tip_radius", "1.1526");
  expect_refused(p, {3.0, 0.9, 4.1, 4.0}, "tool.profile_height", "4.1000");
  p.relief_half_width_mm = 2.5;
  expect_refused(p, pinion_mill(), "relief_half_width", "2.9");
  p = w3();
  p.apex_cone_distance_mm = 90;
  expect_refused(p, pinion_mill(), "apex_cone_distance", "between");
  p = w3();
  p.backlash_mm = 8;
  expect_refused(p, pinion_mill(), "backlash", "must be below");
  p = w1();
  p.face_width_mm = 80;
  expect_refused(p, pinion_mill(), "face_width", "largest possible face width");
  p.face_width_mm = 130;
  expect_refused(p, pinion_mill(), "face_width", "apex");
  p = w1();
  p.outer_spiral_angle_rad = 0;
  p.teeth = 8;
  p.mate_teeth = 9;
  p.face_width_mm = 3;
  p.outer_transverse_module_mm = 6;
  expect_refused(p, {5.0, 0.5, 4.1, 4.8}, "outer_spiral_angle", "cusp");
}

TEST(BevelMesh, ClosedOutwardAndOnTheWalls) {
  for (const auto& p : {w1(), w3()}) {
    const bevel_gear::BevelGear g = made(p, pinion_mill());
    const bevel_gear::BevelPart part(g);
    const auto mesh = mesh::mesh_gear(drawn_solid(part));
    ASSERT_TRUE(mesh);
    std::map<std::pair<int, int>, int> edges;
    double volume = 0;
    for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
      volume += mesh->corner(t, 0).dot(mesh->corner(t, 1).cross(mesh->corner(t, 2))) / 6;
      for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh->triangles[t][k], mesh->triangles[t][(k + 1) % 3]}];
    }
    EXPECT_GT(volume, 0);
    std::size_t open = 0;
    for (const auto& [edge, count] : edges)
      if (count != 1 || edges.find({edge.second, edge.first}) == edges.end()) ++open;
    EXPECT_EQ(open, 0u);
  }
}

// A gear whose walls meet below its tips is refused, also where the equivalent gear still has a land.
TEST(BevelInvariants, ATallerToothIsRefusedBeforeItsWallsMeet) {
  auto p = bevel_test::w1();
  auto mill = bevel_test::pinion_mill();
  const auto made = [&](double addendum) {
    p.addendum_mm = mill.rack_depth_mm = addendum, mill.profile_height_mm = addendum + 0.7;
    return bevel_gear::BevelGear::make(p, mill);
  };
  double low = 4.1, high = 12;
  ASSERT_TRUE(made(low).value_if());
  while (high - low > 1e-6) (made((low + high) / 2).value_if() ? low : high) = (low + high) / 2;
  const auto tall = made(low), pointed = made(high);
  ASSERT_TRUE(tall.value_if());
  EXPECT_GT(tall.value_if()->limits().top_land_mm, 0);
  EXPECT_LT(tall.value_if()->limits().top_land_mm, 1e-5);
  EXPECT_GT(bevel_top_land(*tall.value_if(), tall.value_if()->R_i()), 0.05);
  ASSERT_NE(pointed.refused(), nullptr);
  EXPECT_EQ(pointed.refused()->front().key, "addendum");
  EXPECT_NE(pointed.refused()->front().diagnostic.message.find("the walls as they are cut meet below the tip"),
            std::string::npos);
}

// The tip between the two walls of a tooth as the solid mill leaves them, against what the limits say. The equivalent
// gear is a quarter off it at 8 teeth.
TEST(BevelInvariants, TopLandIsThatOfTheCutTooth) {
  for (const int teeth : {8, 12, 18, 37}) {
    const bevel_gear::BevelGear g = gear_of(design(teeth, 40, 6, 30, 0.28));
    const bevel_gear::FingerSolid solid(g.cutter());
    const auto& half = g.halves().front();
    const double h = g.parameters().addendum_mm, radius = g.R_i() * g.sin_delta() + h * g.cos_delta(),
                 z = g.R_i() * g.cos_delta() - h * g.sin_delta();
    double edge[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
      const auto& w = half.walls[k];
      const double middle = w.trace.theta(w.trace.beta(g.R_i())) / g.sin_delta();
      double in = middle, out = middle - w.sigma * 0.5 * g.pitch();
      for (int n = 0; n < 50; ++n) {
        const double azimuth = 0.5 * (in + out);
        const Vec3 place(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
        const double gap = clearance_of_pass(place, w.trace, w.sigma, half.beta_from[k], half.beta_to[k], solid);
        (gap <= 0 ? in : out) = azimuth;
      }
      edge[k] = in;
    }
    const double land = radius * (g.pitch() - (edge[1] - edge[0])) * std::sqrt(g.R_i() / g.R_0());
    EXPECT_NEAR(g.limits().top_land_mm, land, 1e-6) << teeth;
    RecordProperty("land_" + std::to_string(teeth),
                   std::to_string(g.limits().top_land_mm) + " formula " + std::to_string(bevel_top_land(g, g.R_i())));
  }
}

}  // namespace
}  // namespace toothpath
