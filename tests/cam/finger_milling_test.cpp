// The whole way of the finger mill on the worked gears: plan, approve, verify; planted faults.
#include "cam/finger_check.h"
#include "cam/finger_milling.h"
#include "tests/geometry/bevel_samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

ToolAssembly mill(double tip_radius) {
  ToolAssembly t;
  t.number = 1;
  t.type = CutterType::finger_mill;
  t.module_mm = 3.0;
  t.tip_radius_mm = tip_radius;
  t.rack_depth_mm = 4.1;
  t.profile_height_mm = 4.8;
  t.length_mm = 110;
  t.shank_diameter_mm = 10;
  t.holder = {{32, 32, 40}};
  t.stick_out_mm = 40;
  return t;
}

std::vector<MillingOperation> operations(double chord = 5e-4, double ridge = 0.3) {
  MillingOperation rough, finish;
  rough.type = OperationType::finger_roughing;
  rough.speed_rpm = 4000;
  rough.feed_mm_min = 300;
  rough.ridge_mm = ridge;
  finish.type = OperationType::finger_finishing;
  finish.speed_rpm = 5000;
  finish.feed_mm_min = 250;
  finish.chord_tolerance_mm = chord;
  return {rough, finish};
}

struct Milled {
  BevelGear gear;
  std::vector<ToolAssembly> tools;
  std::vector<MillingOperation> ops;
  std::vector<FingerPlan> plans;
  std::vector<ToolMotion> motions;
};

Milled mill_all(const BevelGearParameters& p, double tip_radius, double chord = 5e-4, double ridge = 0.3) {
  Milled r{made(p, {3.0, tip_radius, 4.1, 4.8}), {mill(tip_radius)}, operations(chord, ridge), {}, {}};
  for (std::size_t i = 0; i < r.ops.size(); ++i) {
    auto plan = plan_finger_operation(r.gear, r.tools[0], r.ops[i], static_cast<int>(i), Tolerances{});
    if (!plan) {
      ADD_FAILURE() << plan.error().message;
      continue;
    }
    const auto m = motions_of(plan->path);
    r.motions.insert(r.motions.end(), m.begin(), m.end());
    r.plans.push_back(std::move(*plan));
  }
  return r;
}

void expect_good(const Milled& r, double chord, double ridge) {
  const FingerGougeCheck check(r.gear, r.tools, r.ops, Tolerances{});
  for (const auto& plan : r.plans) {
    const auto ok = check.approve(plan.path);
    EXPECT_TRUE(ok) << ok.error().message;
  }
  const auto v = check.verify(r.motions);
  EXPECT_LE(v.gouge.measured_mm, 1e-3);
  EXPECT_LE(v.gouge.bound_mm, 2e-3);
  EXPECT_TRUE(v.gouge.rapids_clear);
  EXPECT_GE(v.gouge.clearance_mm, 0.05);
  EXPECT_LE(v.finished.max_mm, chord + 1.5e-3);
  EXPECT_LE(v.finished.bound_mm, chord + 1.5e-3);
  EXPECT_GE(v.ridge.reached_mm, 0);
  EXPECT_LE(v.ridge.reached_mm, ridge);
  EXPECT_LT(v.tilt_rad, 1e-3);
  std::printf("gouge %.4f bound %.4f root %.4f um | excess max %.4f min %.4f bound %.4f um | ridge %.4f at %.2f | clearance %.3f | %zu motions\n",
              1e3 * v.gouge.measured_mm, 1e3 * v.gouge.bound_mm, 1e3 * v.root_gouge_mm, 1e3 * v.finished.max_mm,
              1e3 * v.finished.min_mm, 1e3 * v.finished.bound_mm, v.ridge.reached_mm, v.ridge.cone_distance_mm,
              v.gouge.clearance_mm, v.gouge.motions);
  for (const auto& w : v.gouge.worst)
    std::printf("  worst %s %s depth %.4f op %d zone %d line %d r %.3f z %.3f\n", w.body.c_str(), w.patch.c_str(), w.depth_mm, w.operation, w.zone, w.line, w.radius_mm, w.height_mm);
  for (const auto& plan : r.plans)
    for (const auto& p : plan.passes) std::printf("  %d %d %s %.3f mm %zu points\n", p.half, p.pass, p.name.c_str(), p.length_mm, p.points);
}

TEST(FingerMilling, SingleHandPinion) { expect_good(mill_all(w1(), 0.9), 5e-4, 0.3); }
TEST(FingerMilling, SingleHandWheel) { expect_good(mill_all(w2(), 0.6), 5e-4, 0.3); }
TEST(FingerMilling, HerringbonePinion) { expect_good(mill_all(w3(), 0.9), 5e-4, 0.3); }
TEST(FingerMilling, HerringboneWheel) { expect_good(mill_all(w4(), 0.6), 5e-4, 0.3); }
TEST(FingerMilling, FineRidgeTakesFillPasses) {
  const Milled r = mill_all(w3(), 0.9, 5e-4, 0.02);
  EXPECT_GT(r.plans[0].passes.size(), 4u);
  expect_good(r, 5e-4, 0.02);
}

TEST(FingerMilling, TwoWallPassesAloneLeaveTheRidge) {
  Milled r = mill_all(w1(), 0.9);
  r.motions = motions_of(r.plans[1].path);
  const FingerGougeCheck check(r.gear, r.tools, r.ops, Tolerances{});
  // 2.9 mm at the large end of W1 (section 6.3 of the page).
  EXPECT_NEAR(check.ridge(r.motions).reached_mm, 2.9, 0.06);
}

}  // namespace
}  // namespace toothpath
