// Engagement along a path against what geometry says of a slot, of a step beside it, and of air.
#include "cam/cut/engagement.h"

#include <gtest/gtest.h>

#include "cam/plan/chip_feed.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "tests/support/sample_tools.h"

namespace toothpath {
namespace {

constexpr double kStep = cut::kEngagementStep;

tool::ToolAssembly mill(tool::CutterType type, double diameter) {
  auto t = test::ball_mill(diameter, 3 * diameter, diameter, 6 * diameter, 10);
  t.type = type;
  return t;
}

/// A straight pass along x with the tip at y, z.
path::ToolMotion pass(double y, double z) {
  path::ToolMotion m;
  m.tip_from = {-20, y, z};
  m.tip_to = {20, y, z};
  return m;
}

/// Passes through a block whose top is z = 0 and that is shorter than they are.
std::vector<cut::Engaged> in_block(const tool::ToolAssembly& tool, const std::vector<path::ToolMotion>& motions,
                                   const std::vector<const cut::Removed*>& before = {}) {
  const auto profile = tool::profile_of(tool);
  const auto bodies = tool::proof_tool(tool);
  return cut::engagement_along(
      motions, {profile, bodies.cutting, before, [](const Vec3& p) { return p.z() <= 0 && std::abs(p.x()) < 10; }, 0});
}

TEST(Engagement, ASlotIsHalfATurn) {
  for (const auto type : {tool::CutterType::ball_end_mill, tool::CutterType::flat_end_mill}) {
    const auto found = in_block(mill(type, 4), {pass(0, -3)});
    EXPECT_NEAR(found[0].angle_rad, kPi, kStep);
    EXPECT_NEAR(found[0].steepest, 1, 0.01);
  }
}

// The second of two slots w apart: teeth are in the material over acos(1 - w/R), the largest chip is the sine of that.
TEST(Engagement, AStepBesideASlot) {
  const auto tool = mill(tool::CutterType::flat_end_mill, 4);
  for (const double w : {0.3, 0.8, 1.4, 2.0}) {
    const auto found = in_block(tool, {pass(0, -3), pass(w, -3)});
    const double angle = std::acos(1 - w / 2);
    EXPECT_NEAR(found[0].angle_rad, kPi, kStep);
    EXPECT_NEAR(found[1].angle_rad, angle, kStep) << w;
    EXPECT_NEAR(found[1].steepest, std::sin(angle), std::sin(kStep)) << w;
    EXPECT_LE(found[1].steepest, std::sin(angle) + 1e-9) << w;
  }
}

// What an earlier operation, or the same pass before, has removed is air; so is what is above the block.
TEST(Engagement, AirIsNone) {
  const auto tool = mill(tool::CutterType::ball_end_mill, 4);
  const cut::Removed removed({pass(0, -3)}, tool::proof_tool(tool), 0);
  auto rapid = pass(0, -3);
  rapid.rapid = true;
  const auto found = in_block(tool, {rapid, pass(0, -3)}, {&removed});
  const auto again = in_block(tool, {pass(0, -2), pass(0, -2), pass(0, 0.1)});
  for (const auto& e : {found[0], again[1], again[2]}) {
    EXPECT_EQ(e.angle_rad, 0);
    EXPECT_EQ(e.steepest, 0);
  }
  EXPECT_GT(again[0].steepest, 0.5);
}

// A feed motion in a slot, one beside it and one in air: never above the chip load, three times the feed at most.
TEST(Engagement, FeedsFollowTheChip) {
  const auto tool = mill(tool::CutterType::flat_end_mill, 4);
  path::MillingOperation o;
  o.type = path::OperationType::roughing;
  o.speed_rpm = 10000;
  o.feed_mm_min = 200;
  o.chip_load_mm = 0.02;
  path::ClPath path;
  for (int k = 0; k < 4; ++k)
    path.records.push_back({{double(k), 0, 0}, Vec3::UnitZ(), 200, path::MoveKind::feed, 0, 0});
  const auto track = plan::feed_by_engagement(path, {{kPi, 1}, {1, 0.8}, {0, 0}}, o, 2);
  EXPECT_NEAR(path.records[1].feed_mm_min, 400, 1e-9);
  EXPECT_NEAR(path.records[2].feed_mm_min, 500, 1e-9);
  EXPECT_NEAR(path.records[3].feed_mm_min, 600, 1e-9);
  for (const double chip : track.chip_mm) EXPECT_LE(chip, 0.02 + 1e-12);
  EXPECT_EQ(track.way_mm, (std::vector<double>{1, 2, 3}));
  // Finishing is slowed where the chip asks for it, and never raised.
  o.type = path::OperationType::finishing;
  EXPECT_EQ(o.feed_for(0.1, 2), 200);
  o.chip_load_mm = 0.005;
  EXPECT_NEAR(o.feed_for(1, 2), 100, 1e-9);
  o.chip_load_mm = 0;
  EXPECT_EQ(o.feed_for(1, 2), 200);
}

/// A pass at so many times the feed of 100 mm/min that is asked.
path::ToolMotion fed(double y, double z, double times, int line) {
  path::ToolMotion m = pass(y, z);
  m.minutes = 40 / (100 * times);
  m.line = line;
  return m;
}

cut::Overload overload(const std::vector<path::ToolMotion>& motions, const cut::AskedLoad& asked,
                       const std::vector<const cut::Removed*>& before = {}) {
  const auto tool = mill(tool::CutterType::ball_end_mill, 4);
  const auto profile = tool::profile_of(tool);
  const auto bodies = tool::proof_tool(tool);
  return cut::overload_along(
      motions, {profile, bodies.cutting, before, [](const Vec3& p) { return p.z() <= 0 && std::abs(p.x()) < 10; }, 0},
      asked);
}

TEST(Overload, WhatIsAskedIsNone) {
  const auto found =
      overload({fed(0, -1.5, 1, 1), fed(1, -1.5, 1.4, 2), fed(0, -3, 1, 3), fed(0, -3, 20, 4), fed(0, 0.1, 20, 5)},
               {100, 1.5, INFINITY});
  EXPECT_EQ(found.chip_share, 0);
  EXPECT_EQ(found.depth_mm, 0);
  EXPECT_EQ(found.stock_mm, 0);
}

// A pass is dropped: the next one below it is twice as deep; a link through where it went is quick.
TEST(Overload, OfAPassThatIsMissing) {
  const auto below = overload({fed(0, -3, 1, 7)}, {100, 1.5, INFINITY});
  EXPECT_GT(below.depth_mm, 1.5 * 1.5);
  EXPECT_LT(below.depth_mm, 3);
  EXPECT_EQ(below.depth_line, 7);
  EXPECT_EQ(below.chip_share, 0);
  for (const double times : {1.98, 12.0}) {
    const auto link = overload({fed(0, -3, times, 5)}, {100, 3, INFINITY});
    EXPECT_NEAR(link.chip_share, times, 0.02 * times);
    EXPECT_EQ(link.chip_line, 5);
    EXPECT_EQ(link.depth_mm, 0);
  }
}

// A mill that leans where it goes has its layer high along its axis, and no deeper for that; twice as deep it is.
TEST(Overload, OfAMillThatLeans) {
  constexpr double kLayer = 4 / 3.0;
  const auto leaning = [](double depth) {
    path::ToolMotion m = fed(0, 0, 1, 1);
    m.axis_from = m.axis_to = Vec3(std::sin(radians(30)), 0, std::cos(radians(30)));
    for (Vec3* tip : {&m.tip_from, &m.tip_to}) *tip += Vec3(0, 0, 2 - depth) - 2 * m.axis_from;  // of a ball of 4 mm
    return m;
  };
  EXPECT_EQ(overload({leaning(kLayer)}, {100, kLayer, INFINITY}).depth_mm, 0);
  EXPECT_GT(overload({leaning(2 * kLayer)}, {100, kLayer, INFINITY}).depth_mm, 1.5 * kLayer);
}

// The ball of an operation before stood higher: the stock below it is that difference.
TEST(Overload, OfStockThatAnEarlierOperationLeft) {
  const auto tool = tool::proof_tool(mill(tool::CutterType::ball_end_mill, 4));
  const cut::Removed removed({pass(0, -3)}, tool, 0);
  EXPECT_EQ(overload({fed(0, -3.2, 1, 1)}, {100, 0, 0.2}, {&removed}).stock_mm, 0);
  EXPECT_EQ(overload({fed(0, -3.5, 1, 1)}, {100, 0, INFINITY}, {&removed}).stock_mm, 0);
  const auto found = overload({fed(0, -3.02, 1, 1), fed(0, -3.5, 1, 2)}, {100, 0, 0.1}, {&removed});
  EXPECT_GT(found.stock_mm, 0.3);
  EXPECT_LT(found.stock_mm, 0.48);
  EXPECT_EQ(found.stock_line, 2);
}

// However short the steps of a pass are: what it has just cut itself was no free place that the stock lies below.
TEST(Overload, OfStockUnderShortSteps) {
  const auto tool = tool::proof_tool(mill(tool::CutterType::ball_end_mill, 4));
  const cut::Removed removed({pass(0, -3)}, tool, 0);
  std::vector<path::ToolMotion> steps;
  for (int k = 0; k < 80; ++k) {
    steps.push_back(fed(0, -3.5, 1, k));
    steps.back().tip_from.x() = -12 + 0.1 * k;
    steps.back().tip_to.x() = -12 + 0.1 * (k + 1);
  }
  EXPECT_GT(overload(steps, {100, 0, 0.1}, {&removed}).stock_mm, 0.3);
  EXPECT_EQ(overload(steps, {100, 0, 0.4}, {&removed}).stock_mm, 0);
}

// The side of a mill meets stock all along its height: a mill with a shorter cutting part went there before.
TEST(Overload, OfStockHighBesideTheSide) {
  auto low = mill(tool::CutterType::ball_end_mill, 4);
  low.flute_length_mm = 5;
  const cut::Removed removed({pass(0, -9)}, tool::proof_tool(low), 0);
  const auto found = overload({fed(0, -9, 1, 1)}, {100, 0, 0.2}, {&removed});
  EXPECT_GT(found.stock_mm, 1);
}

}  // namespace
}  // namespace toothpath
