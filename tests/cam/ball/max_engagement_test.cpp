// `max_engagement`: passes of a layer are drawn together until their teeth keep it; those that open a layer are slots.
#include "cam/tool/cutters.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

/// The most of what a track says of the teeth, and the step-over, of one roughing operation with this limit.
Expected<plan::MillingPlan, ball::PlanRefusal> roughed(double most_deg) {
  auto parameters = test::small_spur();
  parameters.zones = {{0, 61, 62}};
  const face_gear::FaceGear gear = test::made(parameters);
  const auto tool = test::ball_mill(1, 6, 0.95, 16, 10);
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  auto op = test::roughing(0, 1.2, 0.6, 0.1);
  op.max_engagement_rad = radians(most_deg);
  return plan::plan_milling(part, {tool}, {op}, {});
}

/// Greatest distance across the tooth from a pass to the nearest one before it in its layer, mm.
double widest_step(const path::ClPath& path) {
  std::map<int, Vec3> middles;  // tip half-way along each pass
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto &from = path.records[k - 1], &to = path.records[k];
    const double r0 = std::hypot(from.tip.x(), from.tip.y()), r1 = std::hypot(to.tip.x(), to.tip.y());
    if (to.kind != path::MoveKind::feed || (r0 - 61.5) * (r1 - 61.5) > 0) continue;
    middles[to.pass] = from.tip + (61.5 - r0) / (r1 - r0) * (to.tip - from.tip);
  }
  double widest = 0;
  for (const auto& [pass, at] : middles) {
    double nearest = INFINITY;
    for (const auto& [earlier, there] : middles)
      if (earlier < pass && std::abs(there.z() - at.z()) < 0.01) nearest = std::min(nearest, (there - at).norm());
    if (nearest < INFINITY) widest = std::max(widest, nearest);
  }
  return widest;
}

TEST(MaxEngagement, PassesAreDrawnTogetherUntilTheyKeepIt) {
  const auto asked = roughed(180), kept = roughed(90);
  ASSERT_TRUE(asked.has_value() && kept.has_value());
  const auto &wide = asked.value().engagement.front(), &narrow = kept.value().engagement.front();
  const auto& layers = kept.value().operations.front();
  EXPECT_EQ(wide.step_over_mm, 0.6);
  EXPECT_GT(wide.beside_rad, radians(95));
  EXPECT_LT(narrow.step_over_mm, 0.5);
  EXPECT_LE(narrow.beside_rad, radians(90));
  EXPECT_GT(narrow.beside_rad, radians(45)) << "closer than needed";
  EXPECT_LE(widest_step(kept.value().paths.front()), narrow.step_over_mm + 1e-6);
  EXPECT_GT(widest_step(asked.value().paths.front()), narrow.step_over_mm);
  // The first pass of each layer is a slot whatever the step-over.
  EXPECT_EQ(int(layers.openings.size()), layers.layers);
  EXPECT_NEAR(*std::max_element(narrow.engaged_rad.begin(), narrow.engaged_rad.end()), kPi, cut::kEngagementStep);
  EXPECT_GT(narrow.opening_mm, 0);
  EXPECT_LT(narrow.opening_mm, narrow.way_mm.back());
}

// No step-over down to a fifth of what is asked keeps 10 deg: it stays as it is asked, and the track tells.
TEST(MaxEngagement, WhatNoStepOverKeepsIsTold) {
  const auto plan = roughed(10);
  ASSERT_TRUE(plan.has_value());
  const auto& track = plan.value().engagement.front();
  EXPECT_EQ(track.step_over_mm, 0.6);
  EXPECT_GT(track.beside_rad, radians(10));
}

// A cylinder of radius 2 is in the material over acos(1 - w / 2) beside a slot.
TEST(MaxEngagement, WidestStepOfACylinder) {
  auto tool = test::ball_mill(4, 12, 4, 24, 10);
  tool.type = tool::CutterType::flat_end_mill;
  const auto mill = tool::profile_of(tool);
  for (const double w : {0.3, 1.0, 2.0, 3.1})
    EXPECT_NEAR(plan::widest_step_mm(mill.cutting(), 1, std::acos(1 - w / 2)), w, 1e-12);
  // A ball is as wide as it is at the depth.
  EXPECT_NEAR(plan::widest_step_mm(tool::profile_of(test::ball_mill(4, 12, 4, 24, 10)).cutting(), 1, 0.5 * kPi),
              std::sqrt(3.0), 1e-9);
}

}  // namespace
}  // namespace toothpath
