// Design and judgement of finger mills: closed conditions against brute force, and against what BevelGear::make says.
#include "geometry/bevel_gear/finger_cutter_design.h"

#include <random>

#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

bevel_gear::FingerCutterDesign designed(const bevel_gear::BevelGearParameters& p) {
  auto made = bevel_gear::design_finger_cutter(p);
  if (const auto* refused = made.refused())
    for (const auto& r : *refused) ADD_FAILURE() << r.key << ": " << r.diagnostic.message;
  return std::move(made).value();
}
const bevel_gear::CutterCondition& condition(const bevel_gear::CutterJudgement& j, const std::string& name) {
  for (const auto& c : j.conditions)
    if (c.name == name) return c;
  ADD_FAILURE() << name;
  return j.conditions.front();
}
bevel_gear::FingerProfile<double> profile_of(const bevel_gear::BevelGear& g, const bevel_gear::FingerCutterData& d) {
  return bevel_gear::make_finger_profile<double>(g.parameters().pressure_angle_rad, g.kappa_v(),
                                                 g.parameters().dedendum_mm, d.module_mm, d.tip_radius_mm,
                                                 d.rack_depth_mm, d.profile_height_mm);
}

TEST(FingerCutterDesign, FollowsItsRulesOnManyGears) {
  for (const auto& p : {w1(), w2(), w3(), w4(), design(12, 60, 3, 45, 0.25).p, design(25, 25, 5, 5, 0.22, -1).p,
                        design(44, 31, 2, 20, 0.3).p, design(30, 0, 4, 35, 0.25, 1, 90).p, design(7, 40, 4, 30, 0.2).p,
                        design(18, 37, 0.1, 30, 0.29).p, design(18, 37, 60, 30, 0.29).p}) {
    const auto d = designed(p);
    const double share = d.data.module_mm / d.gear.normal_module(d.gear.R_i());
    EXPECT_GE(share, 0.97 - 1e-12);
    EXPECT_LE(share, 0.99 + 1e-12);
    const double tip = d.data.tip_radius_mm / largest_tip_radius(profile_of(d.gear, d.data));
    EXPECT_GE(tip, 0.7);
    EXPECT_LE(tip, 0.8 + 1e-12);
    EXPECT_GE(d.data.profile_height_mm, 1.1 * p.addendum_mm * (1 - 1e-12));
    EXPECT_LE(d.data.profile_height_mm, 1.15 * p.addendum_mm * (1 + 1e-12));
    const auto j = bevel_gear::judge_finger_cutter(d.gear, d.data);
    EXPECT_TRUE(j.usable());
    EXPECT_LT(std::max(-j.deepest_mm(), j.proudest_mm()), 1e-9);  // against itself
    EXPECT_EQ(j.small_end_overcut_mm, 0);
  }
}

/// The judgement finds a mill usable exactly where a gear can be made with it that is this one to a hundredth of a
/// module.
TEST(FingerCutterJudgement, AgreesWithWhatTheGearAccepts) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const auto base = designed(w3());
  int usable = 0, refused = 0;
  for (int n = 0; n < 60; ++n) {
    const bevel_gear::FingerCutterData d{2.3 + 0.9 * share(random), 0.2 + 1.3 * share(random),
                                         3.2 + 1.2 * share(random), 3.9 + 1.2 * share(random)};
    const bool accepted = bevel_gear::BevelGear::make(w3(), d).has_value();
    const auto j = bevel_gear::judge_finger_cutter(base.gear, d, {3, 3});
    const double worst = std::max(-j.deepest_mm(), j.proudest_mm());
    EXPECT_EQ(j.usable(), accepted && worst <= 0.01 * base.gear.normal_module(base.gear.R_m()))
        << d.module_mm << ' ' << d.tip_radius_mm << ' ' << d.rack_depth_mm << ' ' << d.profile_height_mm;
    ++(j.usable() ? usable : refused);
  }
  EXPECT_GT(usable, 4);
  EXPECT_GT(refused, 8);
}

/// The wheel's mill on the pinion: its involute belongs to another equivalent gear.
TEST(FingerCutterJudgement, AMillOfAnotherGearIsNotUsable) {
  const auto pinion = designed(w3());
  const auto wheel = designed(w4());
  const auto profile = bevel_gear::make_finger_profile<double>(w4().pressure_angle_rad, wheel.gear.kappa_v(),
                                                               w4().dedendum_mm, 3.0, 0.6, 4.1, 4.8);
  const auto j = bevel_gear::judge_finger_profile(pinion.gear, {3.0, 0.6, 4.1, 4.8}, profile, {5, 5});
  EXPECT_FALSE(j.usable());
  EXPECT_GT(j.proudest_mm() - j.deepest_mm(), 0.05);
}

/// The over-cut of a wide mill, by its solid alone; the page measured 2 um at m_n(R_i) and 157 um at 1.033 of it.
TEST(FingerCutterJudgement, OverCutOfAWideMill) {
  const auto base = designed(w1());
  const double m_i = base.gear.normal_module(base.gear.R_i());
  EXPECT_EQ(bevel_gear::judge_finger_cutter(base.gear, {0.99 * m_i, 0.6, 4.1, 4.8}, {3, 3}).small_end_overcut_mm, 0);
  const auto equal = bevel_gear::judge_finger_cutter(base.gear, {m_i, 0.6, 4.1, 4.8}, {3, 3}),
             wide = bevel_gear::judge_finger_cutter(base.gear, {3.2, 0.6, 4.1, 4.8}, {3, 3});
  EXPECT_NEAR(1000 * equal.small_end_overcut_mm, 2, 0.3);
  EXPECT_NEAR(1000 * wide.small_end_overcut_mm, 157, 2);
  EXPECT_NEAR(wide.small_end_overcut_mm, wide.small_end_estimate_mm, 0.005);
  EXPECT_FALSE(equal.usable());
  EXPECT_FALSE(wide.usable());
}

/// Smaller mill, its own path: micrometres. The same mill on the path of the larger one: the difference of r_0 goes
/// into the tooth.
TEST(FingerCutterJudgement, ASmallerMillServesWithItsOwnPath) {
  const auto base = designed(w1());
  const auto j = bevel_gear::judge_finger_cutter(base.gear, {2.4, 0.5, 4.1, 4.8});
  EXPECT_TRUE(j.usable());
  EXPECT_GT(j.proudest_mm(), 2e-3);
  EXPECT_LT(j.proudest_mm(), 6e-3);
  EXPECT_EQ(condition(j, "not needlessly thin").verdict, bevel_gear::Verdict::remark);
  // The deviation of the worst point by brute force: a point of the designed wall against the smaller mill on its own
  // pass.
  const auto& g = base.gear;
  const bevel_gear::FingerSolid solid(j.profile);
  for (const auto& w : j.walls) {
    const auto& wall = g.halves()[0].wall(w.sigma);
    const auto at = bevel_gear::bevel_inverse(wall, w.greatest_ell, w.greatest_height);
    const auto t = g.trace(g.parameters().hand, j.profile.r_0);
    const double brute = clearance_of_pass(wall.point(at->beta, at->p).p, t, w.sigma, t.beta(g.R_i()) + 0.15,
                                           t.beta(g.R_e()) - 0.1, solid, 2000);
    // Equal height against shortest way: they differ by the slope of the deviation, below 1e-3.
    EXPECT_NEAR(w.greatest_mm, brute, 1e-3 * brute);
    const auto foreign = g.halves()[0].wall(w.sigma).trace;  // the designed mill's path
    const double left = clearance_of_pass(wall.point(at->beta, at->p).p, foreign, w.sigma, foreign.beta(g.R_i()) + 0.15,
                                          foreign.beta(g.R_e()) - 0.1, solid, 2000);
    EXPECT_NEAR(left, kPi / 4 * (base.data.module_mm - 2.4), 0.09);
  }
}

/// Conditions of the profile, each against the solid that it speaks of.
TEST(FingerCutterJudgement, ProfileConditionsAgainstTheSolid) {
  const auto base = designed(w1());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  int pointed = 0, eaten = 0;
  for (int n = 0; n < 300; ++n) {
    const bevel_gear::FingerCutterData d{2.2 + share(random), 0.1 + 3.5 * share(random), 2 + 3 * share(random), 4.8};
    const auto j = bevel_gear::judge_finger_cutter(base.gear, d, {2, 2});
    const auto& c = j.profile;
    EXPECT_EQ(condition(j, "not pointed").verdict == bevel_gear::Verdict::met, c.rho_o >= 0);
    EXPECT_EQ(condition(j, "corner arc below C").verdict == bevel_gear::Verdict::met, c.x_B <= c.x_C);
    pointed += c.rho_o < 0;
    eaten += c.x_B > c.x_C;
    if (c.rho_o < 0 || c.x_B > c.x_C || c.phi < 0) continue;
    // Retractable: the radius never falls towards the shank. Joined parts leave no step.
    const bevel_gear::FingerSolid solid(c);
    double last = 0;
    for (int k = 0; k <= 400; ++k) {
      const double x = -c.h_f + 1e-9 + (c.x_D + c.h_f) * k / 400, rho = solid.radius(x);
      EXPECT_GE(rho, last - 1e-12);
      last = rho;
    }
    for (const double x : {c.x_B, c.x_C}) EXPECT_NEAR(solid.radius(x - 1e-9), solid.radius(x + 1e-9), 1e-7);
  }
  EXPECT_GT(pointed, 20);
  EXPECT_GT(eaten, 20);
  // A mill of few teeth leans inwards when it reaches too deep.
  const auto few = design(7, 40, 4, 30, 0.2);
  const auto gear = designed(few.p);
  EXPECT_EQ(condition(bevel_gear::judge_finger_cutter(gear.gear, gear.data), "C on the involute").verdict,
            bevel_gear::Verdict::remark);
}

/// Top land from the azimuths of both walls of one tooth at the tip of the small end.
TEST(FingerCutterJudgement, TopLandAgainstTheWalls) {
  const auto base = designed(w1());
  const auto& g = base.gear;
  const double stated =
      condition(bevel_gear::judge_finger_cutter(g, base.data, {3, 3}), "top land at the small end").value;
  const auto L = bevel_gear::bevel_inverse(g.halves()[0].walls[0], g.R_i(), 4.1),
             U = bevel_gear::bevel_inverse(g.halves()[0].walls[1], g.R_i(), 4.1);
  const double arc = (g.pitch() - (U->azimuth - L->azimuth)) * (g.R_i() * g.sin_delta() + 4.1 * g.cos_delta());
  const double beta = g.halves()[0].walls[0].trace.beta(g.R_i());
  EXPECT_NEAR(arc * std::cos(beta), stated, 0.03 * stated);
}

TEST(FingerCutterDesign, RefusesAGearThatNoMillMakes) {
  auto p = w1();
  p.face_width_mm = 0.55 * 123.438243669;
  const auto pointed = bevel_gear::design_finger_cutter(p);
  ASSERT_TRUE(!pointed.has_value());
  EXPECT_EQ(pointed.error().front().key, "face_width");
  EXPECT_NE(pointed.error().front().diagnostic.message.find("largest possible face width"), std::string::npos);
  // 0.49 R_e still works with depths that belong to it.
  const auto narrow = designed(design(18, 37, 6, 30, 0.49).p);
  EXPECT_GT(narrow.gear.cutter().rho_o, 0);
  EXPECT_LT(narrow.gear.cutter().rho_o, 0.2);
  p.face_width_mm = 124;
  EXPECT_TRUE(!bevel_gear::design_finger_cutter(p).has_value());
}

TEST(FingerCutterProfile, SamplesKeepTheirChordError) {
  for (const auto& p : {w1(), w2(), design(30, 0, 4, 35, 0.25, 1, 90).p, design(7, 40, 4, 30, 0.2).p}) {
    const auto d = designed(p);
    const bevel_gear::FingerSolid solid(d.gear.cutter());
    for (const double chord : {1e-2, 1e-4}) {
      const auto samples = bevel_gear::sample_profile(d.gear.cutter(), chord);
      double worst = 0;
      for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        EXPECT_GE(samples[i + 1].from_tip, samples[i].from_tip - 1e-12);
        EXPECT_NEAR(solid.signed_distance(samples[i].x, samples[i].rho), 0, 1e-9);
        for (int k = 1; k < 6; ++k) {
          const double t = k / 6.0, x = samples[i].x + t * (samples[i + 1].x - samples[i].x),
                       rho = samples[i].rho + t * (samples[i + 1].rho - samples[i].rho);
          worst = std::max(worst, std::abs(solid.signed_distance(x, rho)));
        }
      }
      EXPECT_LE(worst, chord * 1.001);
    }
  }
}

}  // namespace
}  // namespace toothpath
