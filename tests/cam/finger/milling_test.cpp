// The whole way of the finger mill on the worked gears: plan, approve, verify; planted faults.
#include <random>

#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

TEST(FingerMilling, SingleHandPinion) { expect_good(mill_all(w1(), 0.9), 5e-4, 0.3); }
TEST(FingerMilling, SingleHandWheel) { expect_good(mill_all(w2(), 0.6), 5e-4, 0.3); }
TEST(FingerMilling, HerringbonePinion) { expect_good(mill_all(w3(), 0.9), 5e-4, 0.3); }
TEST(FingerMilling, HerringboneWheel) { expect_good(mill_all(w4(), 0.6), 5e-4, 0.3); }
TEST(FingerMilling, FineRidgeTakesFillPasses) {
  const Milled r = mill_all(w3(), 0.9, 5e-4, 0.02);
  EXPECT_GT(r.plans[0].passes.size(), 4u);
  expect_good(r, 5e-4, 0.02);
}

/// Brute force: lowest height above the root cone at (ell, azimuth) that is inside the cutter at some instant of the
/// two wall passes, by scanning heights and positions.
double left_by_brute_force(const Milled& r, double ell, double azimuth) {
  const bevel_gear::FingerSolid solid(r.gear.cutter());
  const double sd = r.gear.sin_delta(), cd = r.gear.cos_delta();
  double lowest = 1e9;
  for (const auto& half : r.gear.halves())
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i <= 1200; ++i) {
        const auto& t = half.walls[k].trace;
        // The pass and 6 mm of straight run-out.
        const double s = i / 1000.0,
                     beta = half.beta_from[k] + (half.beta_to[k] - half.beta_from[k]) * std::min(s, 1.0);
        auto c = t.centre(half.walls[k].sigma, beta);
        if (s > 1) c = t.run_straight(c, 30 * (s - 1));
        if (std::abs(c.R_c - ell) > 6) continue;
        for (double h = 0; h < std::min(lowest, 9.2); h += 0.002) {
          const Vec3 p = bevel_gear::blank_point(ell, h - 5.1, azimuth, sd, cd);
          if (solid.signed_distance(bevel_gear::cutter_from_blank<double>(p, c.R_c, c.e, sd, cd)) < 0) {
            lowest = h;
            break;
          }
        }
      }
  return lowest;
}

TEST(FingerMilling, TwoWallPassesAloneLeaveTheRidge) {
  Milled r = mill_all(w1(), 0.9);
  r.motions = path::motions_of(r.plans[1].path);
  const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{});
  const finger::RidgeResult ridge = check.ridge(r.motions);
  EXPECT_GT(ridge.reached_mm, 2.8);  // about 3 mm at the large end of W1, ten times what is asked
  EXPECT_NEAR(ridge.cone_distance_mm, r.gear.R_e(), 1.0);
  EXPECT_NEAR(left_by_brute_force(r, ridge.cone_distance_mm, ridge.azimuth_rad), ridge.reached_mm, 0.01);
  // The whole check says so as well.
  EXPECT_GT(check.verify(r.motions).ridge.reached_mm, 2.8);
}

// What the planner says of the highest ridge is never below what the passes leave, and no higher than the job allows;
// many gears, random mills.
TEST(FingerMilling, RidgeIsAsPredicted) {
  std::mt19937 random(11);
  const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967295.0; };
  int made_of = 0, fills = 0;
  double nearest = 0;
  for (int n = 0; n < 14; ++n) {
    Designed d = design(7 + static_cast<int>(uniform(0, 54)), 0, uniform(1, 12), uniform(0, 40), uniform(0.12, 0.3),
                        n % 2 ? 1 : -1, uniform(15, 78));
    const double share = uniform(0.8, 1.0), ridge = uniform(0.02, 0.3) * d.p.dedendum_mm;
    d.c.module_mm *= share, d.c.tip_radius_mm *= 0.5;
    const auto gear = bevel_gear::BevelGear::make(d.p, d.c);
    if (!gear.has_value()) continue;
    Milled r{gear.value(), {mill(d.c)}, operations(2e-3, ridge), {}, {}};
    double predicted = 0;
    for (std::size_t i = 0; i < r.ops.size(); ++i) {
      const auto plan =
          finger::plan_finger_operation(r.gear, r.tools[0], r.ops[i], static_cast<int>(i), proof::ProofLimits{});
      ASSERT_TRUE(plan) << plan.error().message;
      if (i == 0) predicted = plan->ridge_predicted_mm, fills += plan->passes.size() > 1;
      const auto m = path::motions_of(plan->path);
      r.motions.insert(r.motions.end(), m.begin(), m.end());
    }
    const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{},
                                         {.columns = 3, .rows = 3, .ridge_columns = 6, .ridge_rows = 17});
    const double reached = check.ridge(r.motions).reached_mm;
    EXPECT_LE(predicted, ridge) << n;
    EXPECT_LE(reached, 1.0001 * predicted) << n;
    nearest = std::max(nearest, reached / predicted);
    ++made_of;
  }
  EXPECT_GE(made_of, 8);
  EXPECT_GE(fills, 2);
  EXPECT_GT(nearest, 0.8) << "close somewhere";
}

// The proof counts a shift of the centre with the leverage of the points beyond it, on a slender cone of few teeth
// twofold. A job whose chord tolerance is coarse keeps half of the gouge tolerance for what posts add; its walls are
// proven against a little more than this half.
TEST(FingerMilling, ChordLeavesTheProofItsLeverage) {
  for (const Designed& d :
       {design(7, 0, 6.0, 5, 0.145, 1, 15), design(7, 0, 2.0, 30, 0.32, -1, 30), Designed{w3(), pinion_mill()}}) {
    const bevel_gear::BevelGear gear = made(d.p, d.c);
    const double leverage = finger::centre_leverage(gear);
    EXPECT_EQ(leverage, finger::WallReference(gear, 1).leverage());
    proof::ProofLimits job;
    job.gouge_mm = 3e-3;
    const auto tool = mill(d.c);
    const auto ops = operations(2e-3);
    proof::ProofLimits half = job;
    half.gouge_mm = 0.6 * job.gouge_mm;
    const finger::FingerGougeCheck check(gear, std::vector{tool}, ops, half,
                                         {.columns = 3, .rows = 3, .ridge_columns = 2, .ridge_rows = 3});
    for (std::size_t i = 0; i < ops.size(); ++i) {
      const auto plan = finger::plan_finger_operation(gear, tool, ops[i], static_cast<int>(i), job);
      ASSERT_TRUE(plan) << plan.error().message;
      EXPECT_LE(plan->chord_mm * leverage, 0.5 * job.gouge_mm);
      EXPECT_GT(plan->chord_mm * leverage, 0.2 * job.gouge_mm) << "no finer than needed";
      const auto verdict = check.approve(plan->path);
      EXPECT_TRUE(verdict) << verdict.error().message;
    }
    // A chord tolerance below that decides.
    const auto fine = finger::plan_finger_operation(gear, tool, operations(3e-4)[1], 1, job);
    ASSERT_TRUE(fine) << fine.error().message;
    EXPECT_LE(fine->chord_mm, 3e-4);
  }
}

TEST(FingerMilling, FeedIsConstantOnThePitchCone) {
  const Milled r = mill_all(w3(), 0.9);
  for (std::size_t i = 0; i < r.plans.size(); ++i) {
    const auto& records = r.plans[i].path.records;
    for (std::size_t k = 1; k < records.size(); ++k) {
      if (records[k].kind != path::MoveKind::feed) continue;
      const finger::ConePose a = finger::cone_pose(r.gear, records[k - 1].tip, records[k - 1].axis, 0),
                             b = finger::cone_pose(r.gear, records[k].tip, records[k].axis, 0);
      const Vec2 from(a.R_c * std::cos(a.theta), a.R_c * std::sin(a.theta)),
          to(b.R_c * std::cos(b.theta), b.R_c * std::sin(b.theta));
      const double minutes = (records[k].tip - records[k - 1].tip).norm() / records[k].feed_mm_min;
      EXPECT_NEAR((to - from).norm() / minutes / r.ops[i].feed_mm_min, 1, 1e-6);
    }
  }
}

// A place on a wall pass moved 5 um into the wall: the check names it, and no program type can be made of it.
TEST(FingerMilling, PlantedGougesAreFound) {
  const Milled r = mill_all(w3(), 0.9);
  const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{});
  unsigned seed = 12345;
  int planted = 0;
  for (int n = 0; n < 12; ++n) {
    seed = seed * 1664525u + 1013904223u;
    path::ClPath path = r.plans[1].path;
    auto& record = path.records[seed % path.records.size()];
    if (record.kind != path::MoveKind::feed) continue;
    const finger::ConePose pose = finger::cone_pose(r.gear, record.tip, record.axis, 0);
    if (pose.R_c < r.gear.R_i() + 1 || pose.R_c > r.gear.R_e() - 1) continue;
    // Towards the nearer wall: L lies at lower azimuth. Only poses that touch a wall count.
    const finger::WallReference L(r.gear, 1), U(r.gear, -1);
    const bool at_L = std::abs(L.side(pose.R_c, pose.theta)) < std::abs(U.side(pose.R_c, pose.theta));
    const double turn = (at_L ? -1 : 1) * 0.008 / (pose.R_c * r.gear.sin_delta());
    record.tip = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * record.tip;
    record.axis = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * record.axis;
    ++planted;
    const auto verdict = check.approve(path);
    ASSERT_FALSE(verdict);
    EXPECT_NE(verdict.error().message.find(at_L ? "wall L" : "wall U"), std::string::npos) << verdict.error().message;
    if (planted == 1) { EXPECT_GT(check.verify(path::motions_of(path)).gouge.bound_mm, 4e-3); }
  }
  EXPECT_GE(planted, 5);
}

// Over-run at the small end gouges the opposite wall (46 um on W3, section 6.2 of the page).
TEST(FingerMilling, OverrunAtTheSmallEndIsFound) {
  const Milled r = mill_all(w3(), 0.9);
  const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{});
  const auto& half = r.gear.halves()[0];
  const auto& t = half.wall(-1).trace;
  path::ClPath path = r.plans[1].path;
  path.records.clear();
  std::vector<path::ToolMotion> motions = r.motions;
  path::ToolMotion m;
  m.operation = 1;
  // Wall U is eps = +1 there: it must end at R_c = R_i; here it goes on for 6 mm.
  for (int i = 1; i <= 120; ++i) {
    const auto at = [&](double down) {
      double lo = half.beta_from[1], hi = 1.3;
      for (int k = 0; k < 100; ++k) {
        const double mid = 0.5 * (lo + hi);
        (t.centre(-1, mid).R_c > r.gear.R_i() - down ? lo : hi) = mid;
      }
      return t.centre(-1, lo);
    };
    const auto a = at(6.0 * (i - 1) / 120), b = at(6.0 * i / 120);
    m.tip_from = r.gear.tip(a.R_c, a.e);
    m.tip_to = r.gear.tip(b.R_c, b.e);
    m.axis_from = r.gear.axis(a.e);
    m.axis_to = r.gear.axis(b.e);
    motions.push_back(m);
  }
  const auto v = check.verify(motions);
  EXPECT_GT(v.gouge.measured_mm, 0.04);
  EXPECT_GE(v.gouge.bound_mm, v.gouge.measured_mm);
}

TEST(FingerMilling, DeepPlungeShankAndRapidAreFound) {
  const Milled r = mill_all(w3(), 0.9);
  const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{});
  path::ClPath deep = r.plans[0].path;
  for (auto& record : deep.records) record.tip -= 0.004 * record.axis;
  EXPECT_FALSE(check.approve(deep));
  path::ClPath low = r.plans[0].path;
  for (auto& record : low.records)
    if (record.kind == path::MoveKind::rapid) record.tip -= 6 * record.axis;
  EXPECT_FALSE(check.approve(low));
  auto tools = r.tools;
  tools[0].stick_out_mm = 9.0;  // holder into the tips
  const finger::FingerGougeCheck short_tool(r.gear, tools, r.ops, proof::ProofLimits{});
  EXPECT_FALSE(short_tool.approve(r.plans[0].path));
}

}  // namespace
}  // namespace toothpath
