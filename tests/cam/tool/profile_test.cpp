// Cutters as profiles: the ball mills and finger mills that the project had before are representable and give the same
// distances; the law rho(t) against the meridian itself; bodies for proofs enclose; what makes no body is refused.
#include "cam/tool/profile.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/eigen.hpp>

#include "cam/clearance/clearance.h"
#include "cam/finger/finger_profile.h"
#include "cam/tool/body.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "tests/cam/finger/jobs.h"
#include "tests/support/brute_force_line.h"
#include "tests/support/fifty_digits.h"
#include "tests/support/plain_frustum.h"
#include "tests/support/random.h"
#include "tests/support/sample_tools.h"

namespace toothpath::test {
namespace {

using namespace tool;

// The seven numbers of CUTTER draw the cutting part: lower line, corner, upper line. Their distance at points of the
// meridian is nothing.
TEST(AptCutter, DrawsTheCuttingPart) {
  const auto check = [](const tool::ToolAssembly& t) {
    const auto seven = tool::apt_cutter(t);
    ASSERT_TRUE(seven);
    const auto [d, r, e, f, a, b, h] = *seven;
    EXPECT_EQ(a, 0);
    EXPECT_EQ(h, t.flute_length_mm);
    const double tb = std::tan(radians(b)), cb = std::cos(radians(b)), sb = std::sin(radians(b));
    // Where the upper line leaves the corner; it runs from d/2 at the height of the tip.
    EXPECT_NEAR(e + r * cb, d / 2 + (f - r * sb) * tb, 1e-12);
    const tool::Meridian cutting = tool::profile_of(t).cutting();
    for (int k = 0; k <= 40; ++k) {
      const double turn = (kPi / 2 - radians(b)) * k / 40, height = (f - r * sb) + (h - f + r * sb) * k / 40;
      EXPECT_NEAR(cutting.distance(f - r * std::cos(turn), e + r * std::sin(turn)).distance, 0, 1e-12);
      EXPECT_NEAR(cutting.distance(height, d / 2 + height * tb).distance, 0, 1e-12);
    }
  };
  tool::ToolAssembly t = stubby_mill();
  check(t);
  t.type = tool::CutterType::tapered_ball_end_mill;
  t.half_angle_rad = radians(7);
  check(t);
  t.type = tool::CutterType::bull_nose_end_mill;
  t.half_angle_rad = 0;
  t.corner_radius_mm = 0.3 * t.diameter_mm;
  check(t);
  t.type = tool::CutterType::flat_end_mill;
  t.corner_radius_mm = 0;
  check(t);
  t.type = tool::CutterType::finger_mill;
  EXPECT_FALSE(tool::apt_cutter(t));
}

tool::CutterData tapered(double r_0 = 0.25, double half_angle_deg = 5) {
  tool::CutterData d;
  d.shape = tool::CutterShape::tapered_ball;
  d.diameter_mm = 2 * r_0;
  d.half_angle_rad = radians(half_angle_deg);
  d.flute_length_mm = 4;
  d.shank_diameter_mm = 4;
  d.length_mm = 92;
  d.stick_out_mm = 22;
  d.holder = {{10, 10, 30}, {12, 32, 30}};
  return d;
}
tool::CutterData shaped(tool::CutterShape shape, double half_angle_deg = 0, double meridian_radius = 0) {
  tool::CutterData d = tapered(0.5, half_angle_deg);
  d.shape = shape;
  d.diameter_mm = 3;
  d.corner_radius_mm = 0.4;
  d.meridian_radius_mm = meridian_radius;
  d.shank_diameter_mm = 8;
  return d;
}
tool::Profile made_of(const tool::CutterData& d) {
  auto p = tool::Profile::make(d);
  if (auto* refused = std::get_if<std::vector<Refusal>>(&p))
    throw std::runtime_error(refused->front().diagnostic.message);
  return std::get<tool::Profile>(std::move(p));
}
std::vector<tool::CutterData> shapes() {
  return {shaped(tool::CutterShape::ball),
          shaped(tool::CutterShape::tapered_ball, 5),
          shaped(tool::CutterShape::tapered_ball, 10),
          shaped(tool::CutterShape::flat),
          shaped(tool::CutterShape::bull_nose),
          shaped(tool::CutterShape::barrel, 8, 60),
          shaped(tool::CutterShape::barrel, 5, -50)};
}

// The ball mill of an assembly: ball and flute are a capsule, shank and holder the frustums that the proofs use.
TEST(Profile, BallMillOfAnAssembly) {
  Random random(1);
  for (const tool::ToolAssembly& assembly :
       {ball_mill(0.5, 3.2, 0.46, 14, 10), ball_mill(1.6, 8, 1.5, 14, 10), stubby_mill()}) {
    const tool::Profile p = made_of(tool::cutter_data(assembly));
    const double R = assembly.radius_mm(), flute = assembly.flute_length_mm;
    for (int k = 0; k < 3000; ++k) {
      const Vec3 x = random.vector(8) + Vec3(0, 0, 6);
      const double r = x.head<2>().norm();
      // Capsule cut off at the end of the flutes.
      const double capsule = x.z() <= R                 ? (x - Vec3(0, 0, R)).norm() - R
                             : x.z() <= flute && r >= R ? r - R
                             : x.z() > flute            ? std::hypot(x.z() - flute, std::max(0.0, r - R))
                                                        : -std::min(R - r, flute - x.z());
      const double ours_cutting = p.cutting().distance<double>(x.z(), r).distance;
      EXPECT_NEAR(std::max(0.0, ours_cutting), std::max(0.0, capsule), 1e-13);
      EXPECT_EQ(ours_cutting < -1e-12, capsule < -1e-12);
      double frustums = INFINITY, ours = INFINITY;
      for (const auto& f : tool::shank_and_holder(assembly))
        frustums = std::min(frustums, distance_to_frustum(x, f, Vec3::Zero(), Vec3::UnitZ()));
      for (const tool::Meridian* m : {&p.shank(), &p.holder()})
        ours = std::min(ours, std::max(0.0, m->distance<double>(x.z(), r).distance));
      EXPECT_NEAR(ours, frustums, 1e-13);
    }
    const auto bodies = p.proof_bodies(0.01);
    EXPECT_EQ(bodies.ball_height_mm, R);
    EXPECT_EQ(bodies.ball_radius_mm, R);
    EXPECT_EQ(bodies.frustums.size(), 1 + tool::shank_and_holder(assembly).size());
  }
}

// Numbers of an assembly by hand: shank from the flutes to the holder, a shoulder between two segments, the gauge line
// where there is no holder.
TEST(Profile, ShankAndHolderOfAnAssembly) {
  tool::ToolAssembly a = ball_mill(1.6, 8, 1.5, 14, 10);
  a.shank_diameter_mm = 3;
  a.length_mm = 60;
  a.stick_out_mm = 25;
  a.holder = {{20, 24, 10}, {40, 40, 5}};
  const auto same = [](const tool::Frustum& f, double from, double to, double radius_from, double radius_to,
                       Body name) {
    return f.from == from && f.to == to && f.radius_from == radius_from && f.radius_to == radius_to && f.body == name;
  };
  const auto held = tool::shank_and_holder(a);
  ASSERT_EQ(held.size(), 3u);
  EXPECT_TRUE(same(held[0], a.flute_length_mm, 25, 1.5, 1.5, Body::shank));
  EXPECT_TRUE(same(held[1], 25, 35, 10, 12, Body::holder));
  EXPECT_TRUE(same(held[2], 35, 40, 20, 20, Body::holder));
  a.holder.clear();
  const auto bare = tool::shank_and_holder(a);
  ASSERT_EQ(bare.size(), 1u);
  EXPECT_TRUE(same(bare[0], a.flute_length_mm, 60, 1.5, 1.5, Body::shank));
}

// Bodies for meshes of any cutter: a plain ball keeps its ball, the others are enclosed by no more than the sag.
TEST(Profile, MeshBodiesEncloseEveryCutter) {
  Random random(21);
  constexpr double kSag = 1e-3;
  for (const tool::CutterData& d : shapes()) {
    const tool::Profile p = made_of(d);
    const auto bodies = clearance::mesh_bodies(p, kSag);
    EXPECT_EQ(bodies.size(), 1 + tool::shank_and_holder(p).size());
    EXPECT_EQ(bodies[0].ball_mm > 0, d.shape == tool::CutterShape::ball);
    EXPECT_EQ(bodies[0].top_mm(), d.flute_length_mm);
    if (bodies[0].ball_mm > 0) {
      EXPECT_EQ(bodies[0].ball_mm, d.diameter_mm / 2);
      continue;
    }
    for (int k = 0; k < 500; ++k) {
      const double h = random(-1, d.flute_length_mm + 1), r = random(0, 3);
      double cones = INFINITY;
      for (const auto& f : bodies[0].pieces)
        cones = std::min(cones, distance_to_frustum(Vec3(r, 0, h), f, Vec3::Zero(), Vec3::UnitZ()));
      const double truth = std::max(0.0, p.cutting().distance<double>(h, r).distance);
      EXPECT_LE(cones, truth + 1e-12) << h << " " << r;
      EXPECT_GE(cones, truth - 1.01 * kSag) << h << " " << r;
    }
  }
}

// The finger mill: its solid's signed distance within the sag of the arcs, and the truncated cones that meshes are
// checked with.
TEST(Profile, FingerMill) {
  using namespace bevel_test;
  Random random(2);
  for (const Designed& d : {Designed{w3(), pinion_mill()}, Designed{w4(), wheel_mill()}, design(9, 40, 3, 20, 0.25),
                            design(30, 30, 1, 35, 0.2)}) {
    const bevel_gear::BevelGear gear = gear_of(d);
    const bevel_gear::FingerSolid solid(gear.cutter());
    tool::ToolAssembly assembly = mill(d.c);
    assembly.flute_length_mm = d.p.dedendum_mm + d.c.profile_height_mm + 1;
    const double sag = 1e-5, flute = finger::finger_flute_end(gear.cutter(), assembly), rho_D = gear.cutter().rho_D;
    const tool::Meridian m = finger::finger_meridian(gear.cutter(), flute, sag);
    EXPECT_EQ(m.to(), flute);
    EXPECT_LT(2 * m.pieces().size(), finger::finger_profile(gear.cutter(), assembly, sag)
                                         .cutting()
                                         .pieces()
                                         .size());  // arcs follow the involute better than chords
    EXPECT_NEAR(m.largest_radius(), rho_D, 1e-12);
    EXPECT_FALSE(m.convex());  // the flank is hollow
    const auto frustums = m.enclosing_frustums(1e-3, tool::Body::cutter);
    double most = 0;
    for (int k = 0; k < 4000; ++k) {
      const double h = random(-1, flute - 0.5), rho = random(0, 1.5 * rho_D),
                   truth = solid.signed_distance(h - d.p.dedendum_mm, rho);
      const double ours = m.distance<double>(h, rho).distance;
      if (std::abs(truth) < 0.3) {  // deep inside the end of the flutes is nearer
        EXPECT_NEAR(ours, truth, 1.2 * sag) << h << " " << rho;
      }
      double enclosed = INFINITY;
      for (const auto& f : frustums)
        enclosed = std::min(enclosed, distance_to_frustum(Vec3(rho, 0, h), f, Vec3::Zero(), Vec3::UnitZ()));
      EXPECT_LE(enclosed, std::max(0.0, truth) + 1.2 * sag);
      most = std::max(most, std::max(0.0, truth) - enclosed);
    }
    EXPECT_LE(most, 1.1e-3);
  }
}

// rho(t) is the distance from the axis to the side, for every shape; 50 digits and double.
template <typename S>
S worst_law(const tool::CutterData& d) {
  using std::abs, std::sqrt;
  const tool::Profile p = made_of(d);
  tool::RadiusLaw<S> law;
  law.r_0 = S(p.law()->r_0);
  law.sin_tau = S(p.law()->sin_tau);
  law.cos_tau = S(p.law()->cos_tau);
  law.R_m = S(p.law()->R_m);
  S worst(0);
  for (int k = 0; k <= 40; ++k) {
    const S t = S(p.law_end() * 0.97 * k / 40);
    const Vec2T<S> centre(law.r_0 + t, S(0));
    S nearest(1e9);  // place of the meridian; the disc at the end of the flutes is no part of the side
    for (const auto& piece : p.cutting().pieces()) {
      const Vec2T<S> way = tool::nearest_on_piece<S>(piece, centre) - centre;
      nearest = std::min(nearest, S(sqrt(S(way.dot(way)))));
    }
    const S off = abs(S(nearest - law.rho(t)));
    if (off > worst) worst = off;
    const S h = S(1e-4);
    const S slope = (law.rho(S(t + h)) - law.rho(S(t - h))) / (S(2) * h),
            bend = (law.slope(S(t + h)) - law.slope(S(t - h))) / (S(2) * h);
    EXPECT_NEAR(double(slope - law.slope(t)), 0, 1e-9);
    EXPECT_NEAR(double(bend - law.bend(t)), 0, 1e-9);
  }
  EXPECT_NEAR(double(law.rho(S(0)) - law.r_0), 0, 1e-14);
  EXPECT_NEAR(double(law.slope(S(0)) - law.sin_tau), 0, 1e-14);
  return worst;
}
TEST(RadiusLaw, IsTheDistanceFromAxisToSide) {
  for (const auto& d : shapes()) {
    if (d.shape == tool::CutterShape::flat || d.shape == tool::CutterShape::bull_nose) {
      EXPECT_FALSE(made_of(d).law());
      continue;
    }
    EXPECT_LT(worst_law<double>(d), 1e-13) << int(d.shape);
    EXPECT_LT(double(worst_law<F50>(d)), 1e-13) << int(d.shape);  // the tangent points of the meridian are doubles
  }
}

// The cutting part is the union of the balls of its law: the same distance from outside, by a search over the balls.
TEST(Profile, UnionOfBalls) {
  Random random(4);
  for (const auto& d : shapes()) {
    const tool::Profile p = made_of(d);
    if (!p.law()) continue;
    for (int k = 0; k < 400; ++k) {
      const Vec3 x = random.vector(3) + Vec3(0, 0, 1.5);
      const double off = x.head<2>().norm(), h = x.z() - p.law()->r_0;
      const auto gap = [&](double t) { return std::hypot(h - t, off) - p.law()->rho(t); };
      double a = 0, b = p.law_end();
      for (int n = 0; n < 200; ++n) {  // a hollow side may have two ends, so that the least is sought from a scan
        if (n == 0) {
          double best = 0;
          for (int i = 0; i <= 400; ++i)
            if (gap(p.law_end() * i / 400) < gap(best)) best = p.law_end() * i / 400;
          a = std::max(0.0, best - p.law_end() / 400), b = std::min(p.law_end(), best + p.law_end() / 400);
        }
        const double u = a + (b - a) / 3, v = b - (b - a) / 3;
        (gap(u) < gap(v) ? b : a) = gap(u) < gap(v) ? v : u;
      }
      const double t = 0.5 * (a + b), truth = gap(t);
      if (truth < 0 || t > p.law_end() - 0.01) continue;  // the flat end of the flutes is no ball
      EXPECT_NEAR(p.cutting_distance(x).distance, truth, 1e-9) << int(d.shape);
    }
  }
}

TEST(Profile, GradientIsThatOfTheDistance) {
  Random random(5);
  for (const auto& d : shapes()) {
    const tool::Profile p = made_of(d);
    for (int k = 0; k < 300; ++k) {
      const Vec3 x = random.vector(3) + Vec3(0, 0, 1);
      const auto q = p.cutting_distance(x);
      if (q.distance < 1e-3) continue;
      EXPECT_NEAR(q.gradient.norm(), 1, 1e-12);
      const double h = 1e-6;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 e = h * Vec3::Unit(axis);
        EXPECT_NEAR(q.gradient[axis],
                    (p.cutting_distance(x + e).distance - p.cutting_distance(x - e).distance) / (2 * h), 1e-4);
      }
    }
    // On the boundary itself the normal of the piece stands in: at the places of the meridian.
    for (const auto& piece : p.cutting().pieces()) {
      const Vec2 middle = tool::nearest_on_piece<double>(piece, 0.5 * (piece.from + piece.to));
      const auto at = p.cutting().distance<double>(middle[0], middle[1]);
      const auto out = p.cutting().distance<double>(middle[0] + 1e-3 * piece_normal<double>(piece, middle)[0],
                                                    middle[1] + 1e-3 * piece_normal<double>(piece, middle)[1]);
      EXPECT_NEAR(at.distance, 0, 1e-13);
      EXPECT_NEAR(out.distance, 1e-3, 1e-12);
    }
  }
}

// A tapered mill against the plain union of balls that the swept tests use: two texts, one tool.
TEST(Profile, TaperedMillAgainstBruteForce) {
  Random random(6);
  const tool::Profile p = made_of(tapered());
  const BruteConicalMill brute{0.25, radians(5)};
  for (int k = 0; k < 2000; ++k) {
    const Vec3 x = random.vector(1) + Vec3(0, 0, 1.2);
    const double truth = brute.distance(x, {Vec3::Zero(), Vec3::UnitZ()});
    if (truth < 0) continue;
    EXPECT_NEAR(p.cutting_distance(x).distance, truth, 1e-13);
  }
  EXPECT_TRUE(p.cutting().convex());
  EXPECT_NEAR(p.cutting().radius(4.0),
              0.25 * std::cos(radians(5)) + (4 - 0.25 * (1 - std::sin(radians(5)))) * std::tan(radians(5)), 1e-14);
  EXPECT_NEAR(p.shank().radius(4.0), p.cutting().radius(4.0), 1e-14);  // the cone goes on
  EXPECT_NEAR(p.shank().radius(21.9), 2, 1e-13);
  // law_end: the ball there touches at the end of the flutes.
  const double tau = radians(5), t = p.law_end();
  EXPECT_NEAR(0.25 + t - (0.25 + t * std::sin(tau)) * std::sin(tau), 4, 1e-12);
}

TEST(Profile, Convexity) {
  for (const auto& d : shapes()) EXPECT_EQ(made_of(d).cutting().convex(), !(d.meridian_radius_mm < 0)) << int(d.shape);
  const tool::Profile p = made_of(tapered());
  EXPECT_TRUE(p.shank().convex() || p.shank().pieces().size() > 1);
  EXPECT_FALSE(tool::Meridian({{Vec2(0, 1), Vec2(1, 1), 0}, {Vec2(1, 1), Vec2(1, 2), 0}, {Vec2(1, 2), Vec2(2, 2), 0}})
                   .convex());  // a shoulder above
}

// Bodies for proofs contain the tool and stand out of it by no more than the sag.
TEST(Profile, ProofBodiesEnclose) {
  Random random(7);
  for (const auto& d : shapes()) {
    const tool::Profile p = made_of(d);
    const double sag = 2e-3;
    const auto bodies = p.proof_bodies(sag);
    double most = 0;
    for (int k = 0; k < 3000; ++k) {
      const Vec3 x = random.vector(6) + Vec3(0, 0, 3);
      const double r = x.head<2>().norm();
      double truth = INFINITY, enclosed = INFINITY;
      for (const tool::Meridian* m : {&p.cutting(), &p.shank(), &p.holder()})
        truth = std::min(truth, std::max(0.0, m->distance<double>(x.z(), r).distance));
      for (const auto& f : bodies.frustums)
        enclosed = std::min(enclosed, distance_to_frustum(x, f, Vec3::Zero(), Vec3::UnitZ()));
      if (bodies.ball_radius_mm > 0)
        enclosed =
            std::min(enclosed, std::max(0.0, (x - Vec3(0, 0, bodies.ball_height_mm)).norm() - bodies.ball_radius_mm));
      EXPECT_LE(enclosed, truth + 1e-12) << int(d.shape);
      most = std::max(most, truth - enclosed);
    }
    EXPECT_LE(most, 1.01 * sag) << int(d.shape);
  }
}

// A measured meridian: the distance to the union of the balls rho + f, and bodies that contain it.
TEST(Profile, MeasuredMeridian) {
  Random random(8);
  auto d = tapered();
  tool::MeridianError table;
  for (int k = 0; k <= 20; ++k) {
    table.t.push_back(0.2 * k);
    table.f.push_back(0.004 * std::sin(0.9 * table.t.back()) - 0.001);
  }
  d.meridian = table;
  const tool::Profile p = made_of(d);
  ASSERT_TRUE(p.law()->error);
  for (std::size_t k = 0; k < table.t.size(); ++k)
    EXPECT_NEAR(p.law()->rho(table.t[k]), 0.25 + table.t[k] * std::sin(radians(5)) + table.f[k], 1e-15);
  EXPECT_NEAR(p.law()->slope(1.03), (p.law()->rho(1.03 + 1e-6) - p.law()->rho(1.03 - 1e-6)) / 2e-6, 1e-8);
  const auto bodies = p.proof_bodies(1e-3);
  for (int k = 0; k < 500; ++k) {
    const double t_0 = random(0.1, 3.2), out = random(0, 0.2), tau = radians(5), phi = random(0, 6.28);
    // Above the side: the normal from the axis at t_0.
    const Vec3 x =
        Vec3(0, 0, 0.25 + t_0) + (0.25 + t_0 * std::sin(tau) + out) *
                                     Vec3(std::cos(tau) * std::cos(phi), std::cos(tau) * std::sin(phi), -std::sin(tau));
    double truth = INFINITY;
    for (int i = -400; i <= 400; ++i) {
      const double t = t_0 + i * 1e-4;
      truth = std::min(truth, (x - Vec3(0, 0, 0.25 + t)).norm() - p.law()->rho(t));
    }
    EXPECT_NEAR(p.cutting_distance(x).distance, truth, 1.3e-5 * (p.law()->rho(t_0) + out));  // f' <= 0.0036
    double enclosed = (x - Vec3(0, 0, bodies.ball_height_mm)).norm() - bodies.ball_radius_mm;
    for (const auto& f : bodies.frustums)
      enclosed = std::min(enclosed, distance_to_frustum(x, f, Vec3::Zero(), Vec3::UnitZ()));
    EXPECT_LE(enclosed, std::max(0.0, truth) + 1e-9);
  }
}

TEST(Profile, RefusesWhatMakesNoBody) {
  const auto refused = [](tool::CutterData d, const std::string& key, const std::string& text) {
    const auto p = tool::Profile::make(d);
    const auto* list = std::get_if<std::vector<Refusal>>(&p);
    ASSERT_TRUE(list) << key;
    EXPECT_EQ(list->front().key, key);
    EXPECT_NE(list->front().diagnostic.message.find(text), std::string::npos) << list->front().diagnostic.message;
  };
  const auto with = [](auto change) {
    tool::CutterData d = tapered();
    change(d);
    return d;
  };
  for (const double angle : {0.0, -5.0, 45.0, 80.0})
    refused(tapered(0.25, angle), "half_angle", "lies above 0 and below 45 deg");
  refused(with([](tool::CutterData& d) { d.half_angle_rad = NAN; }), "half_angle", "half_angle");
  refused(with([](tool::CutterData& d) { d.diameter_mm = 0; }), "diameter", "diameter = 0.0000 mm");
  refused(with([](tool::CutterData& d) { d.diameter_mm = INFINITY; }), "diameter", "diameter");
  refused(with([](tool::CutterData& d) { d.flute_length_mm = 0.2; }), "flute_length",
          "flute_length = 0.2000 mm is below 0.2500 mm");
  refused(with([](tool::CutterData& d) { d.shank_diameter_mm = 0.4; }), "shank_diameter",
          "thinner than the end of the flutes");
  refused(with([](tool::CutterData& d) { d.shank_diameter_mm = 1.1; }), "shank_diameter", "1.1581 mm");
  refused(with([](tool::CutterData& d) { d.stick_out_mm = 3; }), "stick_out",
          "stick_out = 3.0000 mm is below the flute_length 4.0000 mm");
  refused(with([](tool::CutterData& d) { d.holder.push_back({10, 0, 5}); }), "holder", "holder segment [10, 0, 5]");
  refused(with([](tool::CutterData& d) {
            d.shape = tool::CutterShape::bull_nose;
            d.corner_radius_mm = 0.3;
          }),
          "corner_radius", "no more than 0.2500 mm");
  refused(with([](tool::CutterData& d) {
            d.shape = tool::CutterShape::bull_nose;
            d.corner_radius_mm = 0;
          }),
          "corner_radius", "above 0");
  refused(with([](tool::CutterData& d) {
            d.shape = tool::CutterShape::barrel;
            d.meridian_radius_mm = 0.2;
          }),
          "meridian_radius", "more than the ball's radius");
  refused(with([](tool::CutterData& d) {
            d.shape = tool::CutterShape::barrel;
            d.meridian_radius_mm = 20;
          }),
          "meridian_radius", "it must not narrow");
  const auto table = [&](std::vector<double> t, std::vector<double> f) {
    return with([&](tool::CutterData& d) { d.meridian = tool::MeridianError{t, f}; });
  };
  refused(table({0}, {0}), "meridian", "two points at least");
  refused(table({0.5, 1}, {0, 0}), "meridian", "must begin at the centre of the ball");
  refused(table({0, 1, 1}, {0, 0, 0}), "meridian", "heights ascend");
  refused(table({0, 1}, {0, 3.0}), "meridian", "is it in micrometres?");
  tool::CutterData all = tapered(0.25, 60);
  all.flute_length_mm = -1;
  all.shank_diameter_mm = 0;
  EXPECT_EQ(std::get<std::vector<Refusal>>(tool::Profile::make(all)).size(), 3u);
}

// Between the stated holder and the spindle nose its last diameter goes on.
TEST(Body, TheHolderGoesOnToTheGaugeLine) {
  ToolAssembly t = ball_mill(2, 4, 1.8, 12, 10);  // 80 mm long, its holder from 12 to 72 mm
  const auto rest = holder_to_gauge_line(t);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->from, 72);
  EXPECT_EQ(rest->to, 80);
  EXPECT_EQ(rest->radius_from, 16);
  EXPECT_EQ(rest->radius_to, 16);
  EXPECT_EQ(rest->body, Body::holder);
  t.length_mm = 72;
  EXPECT_FALSE(holder_to_gauge_line(t));
  t.length_mm = 60;
  EXPECT_FALSE(holder_to_gauge_line(t));
  t.length_mm = 80;
  t.holder.clear();
  EXPECT_FALSE(holder_to_gauge_line(t));
}

}  // namespace
}  // namespace toothpath::test
