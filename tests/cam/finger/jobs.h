// Bevel gears milled as a job asks for it, from plan to motions, for the tests of the finger mill.
#pragma once

#include "cam/finger/check.h"
#include "cam/finger/milling.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath::bevel_test {

/// T1 with this profile; holder and stick-out as in the samples.
inline tool::ToolAssembly mill(const bevel_gear::FingerCutterData& c) {
  tool::ToolAssembly t;
  t.number = 1;
  t.type = tool::CutterType::finger_mill;
  t.module_mm = c.module_mm;
  t.tip_radius_mm = c.tip_radius_mm;
  t.rack_depth_mm = c.rack_depth_mm;
  t.profile_height_mm = c.profile_height_mm;
  t.length_mm = 110;
  t.shank_diameter_mm = 10;
  t.holder = {{32, 32, 40}};
  t.stick_out_mm = 40;
  return t;
}

inline std::vector<path::MillingOperation> operations(double chord = 5e-4, double ridge = 0.3) {
  path::MillingOperation rough, finish;
  rough.type = path::OperationType::finger_roughing;
  rough.speed_rpm = 4000;
  rough.feed_mm_min = 300;
  rough.ridge_mm = ridge;
  finish.type = path::OperationType::finger_finishing;
  finish.speed_rpm = 5000;
  finish.feed_mm_min = 250;
  finish.chord_tolerance_mm = chord;
  return {rough, finish};
}

struct Milled {
  bevel_gear::BevelGear gear;
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> ops;
  std::vector<finger::FingerPlan> plans;
  std::vector<path::ToolMotion> motions;
};

inline Milled mill_all(const Designed& d, double chord = 5e-4, double ridge = 0.3) {
  Milled r{made(d.p, d.c), {mill(d.c)}, operations(chord, ridge), {}, {}};
  for (std::size_t i = 0; i < r.ops.size(); ++i) {
    auto plan = finger::plan_finger_operation(r.gear, r.tools[0], r.ops[i], static_cast<int>(i), proof::ProofLimits{});
    if (!plan) {
      ADD_FAILURE() << plan.error().message;
      continue;
    }
    const auto m = path::motions_of(plan->path);
    r.motions.insert(r.motions.end(), m.begin(), m.end());
    r.plans.push_back(std::move(*plan));
  }
  return r;
}

/// The worked gears with the mills of the samples.
inline Milled mill_all(const bevel_gear::BevelGearParameters& p, double tip_radius, double chord = 5e-4,
                       double ridge = 0.3) {
  return mill_all(Designed{p, {3.0, tip_radius, 4.1, 4.8}}, chord, ridge);
}

/// The small pinion of samples/bevel_trunnion.toml, with hub and shaft.
inline Milled mill_trunnion(double chord = 5e-4) {
  bevel_gear::BevelGearParameters p = w3();
  p.mate_teeth = 27;
  p.outer_transverse_module_mm = 2;
  p.face_width_mm = 14;
  p.apex_cone_distance_mm = 25.45, p.relief_half_width_mm = 1.1;
  p.addendum_mm = 1.2, p.dedendum_mm = 1.5, p.backlash_mm = 0.05;
  p.hub_diameter_mm = 24, p.hub_length_mm = 10;
  p.shaft_diameter_mm = 8, p.shaft_length_mm = 6;
  Milled r = mill_all(Designed{p, {0.72, 0.12, 1.2, 1.4}}, chord, 0.1);
  r.tools[0].length_mm = 70, r.tools[0].shank_diameter_mm = 6, r.tools[0].holder = {{20, 20, 40}},
  r.tools[0].stick_out_mm = 25;
  return r;
}

/// Passes of approve and verify with everything within its limit.
inline void expect_good(const Milled& r, double chord, double ridge, const finger::FingerCheckOptions& options = {}) {
  const finger::FingerGougeCheck check(r.gear, r.tools, r.ops, proof::ProofLimits{}, options);
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
}

}  // namespace toothpath::bevel_test
