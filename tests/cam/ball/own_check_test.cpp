// A plan passes its own check, or the planner says what keeps it from one, and what would help.
#include <ctime>

#include "cam/analytic/body_sweep.h"
#include "cam/ball/sheet_pass.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

/// Helical teeth that end 0.5 mm farther out, close to where a fillet folds: only slices have a proven bend there.
face_gear::FaceGearParameters short_helical_gear() {
  face_gear::FaceGearParameters g;
  g.teeth = 90;
  g.shaper_teeth = 55;
  g.module_mm = 0.6;
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(14.69);
  g.shaft_angle_rad = radians(87.9);
  g.offset_mm = 0.23;
  g.shaper_tip_radius_mm = 0.15;
  g.zones = {{radians(25.5), 28.066, 28.546}};
  return g;
}

TEST(OwnCheck, AGapIsProvenBesideAFoldedFillet) {
  auto tool = test::ball_mill(0.45, 0.68, 0.305, 7.05, 12);
  const auto job = test::planned(short_helical_gear(), {tool}, {test::roughing(0, 0.2, 0.214, 0.027)});
  EXPECT_EQ(job.part->unproven(), 0u);
  auto options = job.check_options();
  options.limits.gouge_mm = 0.003;
  const auto passed = analytic::GougeCheck(*job.part, job.tools, options).check_path(job.plan.paths[0]);
  EXPECT_TRUE(passed) << passed.error().message;
  analytic::SweptGapOptions look;
  look.enough_mm = 0.75;
  std::size_t most = 0;
  for (const auto& m : job.motions())
    most = std::max(most, analytic::swept_gap(*job.part, tool::shank_and_holder(tool).front(), m, look).pieces);
  EXPECT_LT(most, 20000u);
}

// A gap that is found to be as large as asked is followed until that is proven, however little it is more.
TEST(OwnCheck, AGapThatIsHardlyMoreThanAskedIsProven) {
  const auto& job = test::job_named("spur");
  const auto& path = job.plan.paths.back();
  const double R = job.tool(path.operation).radius_mm();
  int undecided = 0;
  for (std::size_t k = 5; k + 1 < path.records.size(); k += path.records.size() / 40) {
    const auto& record = path.records[k];
    const tool::Frustum shank{2 * R, 8, R + 0.12, R + 0.12, tool::Body::shank};
    path::ToolMotion m;
    m.tip_from = record.tip;
    m.tip_to = record.tip + Vec3(0.05, 0.02, 0);
    m.axis_from = m.axis_to = record.axis;
    analytic::SweptGapOptions look;
    look.contact_mm = 0.005;
    const auto plain = analytic::swept_gap(*job.part, shank, m, look);
    if (plain.measured_mm < 0.01 || plain.measured_mm >= look.enough_mm) continue;
    look.asked_mm = plain.measured_mm - 0.0005;
    const auto asked = analytic::swept_gap(*job.part, shank, m, look);
    if (asked.measured_mm < look.asked_mm) continue;  // a nearer place was found
    undecided += plain.proven_mm < look.asked_mm;
    EXPECT_GE(asked.proven_mm, look.asked_mm) << k;
    EXPECT_LE(asked.proven_mm, asked.measured_mm) << k;
  }
  EXPECT_GT(undecided, 3);
}

// Every place of a pass is free, and on the way from one wall of a tooth to the other one the ball goes through it.
TEST(OwnCheck, AWayThroughATooth) {
  const auto& job = test::job_named("spur");
  const auto& path = job.plan.paths.back();
  const double R = job.tool(path.operation).radius_mm(), limit = 0.002;
  const auto distance = [&](const Vec3& centre) { return job.part->nearest(centre, R + 0.01).distance; };
  const auto turned = [&](const Vec3& p) -> Vec3 { return Eigen::AngleAxisd(job.gear.pitch(), Vec3::UnitZ()) * p; };
  std::vector<ball::BallPass> passes(2);
  int told = 0;
  for (std::size_t k = 1; k < path.records.size(); k += 1 + path.records.size() / 60) {
    const auto &before = path.records[k - 1], &here = path.records[k];
    if (before.kind != path::MoveKind::feed || here.kind != path::MoveKind::feed || before.pass != here.pass) continue;
    const Vec3 from = before.tip + R * before.axis, to = here.tip + R * here.axis;
    passes[0].points = {{from, from, true}, {to, to, true}};
    passes[1].points = {{to, to, true}, {turned(to), turned(to), true}};
    EXPECT_FALSE(ball::first_deep_place(passes, R, limit, distance)) << k;
    EXPECT_FALSE(ball::first_deep_way({passes[0]}, R, limit, distance)) << k;
    double most = -INFINITY;
    for (int i = 1; i < 200; ++i) most = std::max(most, R - distance(to + i / 200.0 * (turned(to) - to)));
    const auto deep = ball::first_deep_way(passes, R, limit, distance);
    if (most < 0.1) continue;  // above the teeth
    ASSERT_TRUE(deep) << k;
    ++told;
    EXPECT_LE(deep->cut_mm, most + 0.01) << k;
    EXPECT_GE(deep->cut_mm, most - 0.2 * R) << k;
    EXPECT_NEAR(R - distance(deep->centre), deep->cut_mm, 1e-12);
  }
  EXPECT_GT(told, 10);
  passes[1].points[1].centre.z() -= 2 * R;
  EXPECT_TRUE(ball::first_deep_place(passes, R, limit, distance));
}

double processor_seconds(const std::function<void()>& work) {
  const std::clock_t from = std::clock();
  work();
  return double(std::clock() - from) / CLOCKS_PER_SEC;
}

// A path that is wrong everywhere is left at its first fault.
TEST(OwnCheck, AWrongPathIsLeftSoon) {
  const auto& job = test::job_named("spur");
  path::ClPath path = job.plan.paths.back();
  for (auto& record : path.records) record.tip.z() -= 0.3;
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  const double all = processor_seconds([&] {
    EXPECT_FALSE(check.passes(check.check(analytic::GougeCheck::motions_of(path), job.tool_of_operation())));
  });
  const double soon = processor_seconds([&] { EXPECT_FALSE(check.check_path(path)); });
  EXPECT_LT(soon, 0.4 * all);
}

ball::PlanRefusal refusal_to(std::vector<path::MillingOperation> operations) {
  auto parameters = test::small_spur();
  parameters.zones.front().outer_radius_mm = 61;
  const auto gear = test::made(parameters);
  const std::vector tools = {test::ball_mill(1, 6, 0.95, 16, 10)};
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(tools));
  const auto plan = plan::plan_milling(part, tools, operations, {});
  EXPECT_FALSE(plan.has_value());
  return plan.has_value() ? ball::PlanRefusal{} : *plan.refused();
}

TEST(OwnCheck, AnOperationWithNothingToCutSaysWhy) {
  const auto refusal = refusal_to({test::roughing(0, 0.8, 0.5, 0.1), test::roughing(0, 0.8, 0.5, 0.1)});
  EXPECT_EQ(refusal.key, "operation[1]");
  EXPECT_NE(refusal.diagnostic.message.find("has nothing to cut: none of its "), std::string::npos)
      << refusal.diagnostic.message;
}

TEST(OwnCheck, StockThatIsGoneCannotBeLeft) {
  const auto refusal = refusal_to({test::roughing(0, 0.8, 0.5, 0.05), test::finishing(0, 0.02, 0.004, 0.08)});
  EXPECT_EQ(refusal.key, "operation[1].allowance");
  EXPECT_EQ(refusal.diagnostic.message,
            "allowance = 0.08 mm cannot be left: operation 0 (roughing) before it has cut down to 0.05 mm already, "
            "below 0.064 mm (0.8 of it); 0.05 or less would do, or a larger allowance of operation 0");
}

}  // namespace
}  // namespace toothpath
