// Rapids that turn the rotary axes: clear of a ring, near it and through it, against dense sampling of the whole tool.
#include "cam/proof/rapid_clearance.h"

#include "cam/path/motion_blend.h"
#include "cam/tool/body.h"
#include "cam/tool/proof_tool.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

tool::ToolAssembly long_tool() { return test::ball_mill(2, 8, 1.9, 20, 12); }
constexpr proof::RapidObstacle kRing{60, 30, 5, -20};

/// The least height of the tool above the ring's top where it stands over the ring, and whether it is inside anywhere,
/// at many moments.
bool sampled_clear(const path::ToolMotion& m, const tool::ToolAssembly& tool, double margin) {
  std::vector<tool::Frustum> bodies = tool::shank_and_holder(tool);
  const double R = tool.radius_mm();
  bodies.push_back({0.3 * R, tool.flute_length_mm, 0.7 * R, R, tool::Body::flute});
  for (int step = 0; step <= 80; ++step) {
    const Vec3 tip = path::tip_at(m, step / 80.0), axis = path::axis_at(m, step / 80.0), u = axis.unitOrthogonal(),
               v = axis.cross(u);
    for (const auto& body : bodies)
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; j < 16; ++j) {
          const double h = body.from + (body.to - body.from) * i / 8,
                       radius = body.radius_from + (body.radius_to - body.radius_from) * i / 8;
          const Vec3 p = tip + h * axis + radius * (std::cos(j * kPi / 8) * u + std::sin(j * kPi / 8) * v);
          const double r = p.head<2>().norm();
          if (r < kRing.outer_radius_mm - margin && r > kRing.inner_radius_mm + margin &&
              p.z() < kRing.top_mm - margin && p.z() > kRing.bottom_mm + margin)
            return false;
        }
  }
  return true;
}

path::ToolMotion turning(const Vec3& tip, double from, double to, double azimuth, const Vec3& travel = Vec3::Zero()) {
  const auto leaning = [&](double lean) {
    return Vec3(std::sin(lean) * std::cos(azimuth), std::sin(lean) * std::sin(azimuth), std::cos(lean));
  };
  path::ToolMotion m;
  m.rapid = true;
  m.axis_from = leaning(from);
  m.axis_to = leaning(to);
  m.tip_from = tip;
  m.tip_to = tip + travel;
  return m;
}

TEST(TurningRapid, HighAboveIsClear) {
  const auto proof = proof::prove_rapid(turning(Vec3(45, 0, 30), -0.8, 0.8, 0.4), long_tool(), kRing);
  EXPECT_TRUE(proof.clear);
}

TEST(TurningRapid, TheHolderSwingsIntoTheRing) {
  // Both ends are clear: upright above the ring, and lying beside it; on the way the holder comes down on the ring.
  const auto tool = long_tool();
  const auto m = turning(Vec3(61.5, 0, 5.5), 0, -1.5, 0);
  path::ToolMotion start = m;
  start.axis_to = start.axis_from;
  EXPECT_TRUE(proof::prove_rapid(start, tool, kRing).clear);
  const auto proof = proof::prove_rapid(m, tool, kRing);
  EXPECT_FALSE(proof.clear);
  EXPECT_FALSE(sampled_clear(m, tool, 0));
  // The same swing away from the gear is clear.
  EXPECT_TRUE(proof::prove_rapid(turning(Vec3(61.5, 0, 5.5), 0, 1.4, 0), tool, kRing).clear);
}

TEST(TurningRapid, OnlyTheMiddleOfTheTurnIsTooLow) {
  // The axis passes a deep lean half way: neither end shows it.
  const auto tool = long_tool();
  path::ToolMotion m = turning(Vec3(45, 0, 5.8), 0, 0, 0);
  m.axis_from = Vec3(1, 0, 0.45).normalized();
  m.axis_to = Vec3(-1, 0.02, 0.45).normalized();
  m.tip_from = Vec3(90, 0, 5.8);
  m.tip_to = Vec3(20, 0, 5.8);
  EXPECT_EQ(proof::prove_rapid(m, tool, kRing).clear, sampled_clear(m, tool, 1e-4));
}

// A tool that leans away from the gear goes across beside it: its tip is below the top of the ring and its holder
// within reach of it, but the plane across the axis at the tip has all of the ring below. A millimetre lower it has
// not.
TEST(TurningRapid, TheFootOfALeaningToolPassesAboveTheRing) {
  const auto tool = test::ball_mill(1, 3, 0.95, 5.8, 38);
  const double lean = radians(22.7), reach = kRing.top_mm * std::cos(lean) + kRing.outer_radius_mm * std::sin(lean);
  for (const double above : {0.01, 4.0}) {
    path::ToolMotion m = turning(Vec3(62, 0, 0), lean, lean, 0);
    m.tip_from.z() = (reach + above - m.tip_from.x() * std::sin(lean)) / std::cos(lean);
    m.tip_to = m.tip_from + 90 * Vec3(std::cos(lean), 0.4, -std::sin(lean));
    EXPECT_LT(m.tip_to.z(), kRing.top_mm - 20);
    EXPECT_TRUE(proof::prove_rapid(m, tool, kRing).clear) << above;
    EXPECT_TRUE(sampled_clear(m, tool, 1e-6)) << above;
  }
  path::ToolMotion low = turning(Vec3(55, 0, 4), lean, lean, 0, Vec3(-10, 0, 4.2));
  EXPECT_FALSE(proof::prove_rapid(low, tool, kRing).clear);
  EXPECT_FALSE(sampled_clear(low, tool, 0));
}

TEST(TurningRapid, NeverCallsATouchClear) {
  test::Random random(12);
  const auto tool = long_tool();
  int clear = 0, hit = 0, near = 0;
  for (int k = 0; k < 300; ++k) {
    const double r = random(25, 75), phi = random(-3.1, 3.1);
    const auto m = turning(Vec3(r * std::cos(phi), r * std::sin(phi), random(3, 13)), random(-1.3, 1.3),
                           random(-1.3, 1.3), random(-3.1, 3.1),
                           k % 2 == 0 ? Vec3::Zero().eval() : Vec3(random(-3, 3), random(-3, 3), random(-3, 3)));
    const bool proven = proof::prove_rapid(m, tool, kRing).clear;
    const bool free = sampled_clear(m, tool, 1e-6), wide = sampled_clear(m, tool, -0.5);
    clear += proven;
    hit += !free;
    near += free && !wide;
    if (proven) { EXPECT_TRUE(free) << k; }
  }
  EXPECT_GE(clear, 40);
  EXPECT_GE(hit, 30);
  EXPECT_GE(near, 2);
}

/// A tapered mill that goes round a cylinder, its thin end next to it: neither is a touch called clear, nor a thin end
/// taken as wide as the mill grows.
TEST(TurningRapid, AThinEndIsNotTakenAsWideAsItGrows) {
  constexpr proof::RapidObstacle kCylinder{80, 0, 25, -25};
  tool::ProofTool tool;
  tool.cutting = {{{1, 14, 0, 1.2, tool::Body::flute}, 1}};
  tool.bodies = {{16, 40, 3, 3, tool::Body::shank}, {40, 80, 16, 16, tool::Body::holder}};
  /// Nearest place to the z axis over the motion, sampled.
  const auto least_radius = [&](const path::ToolMotion& m) {
    double least = INFINITY;
    for (int step = 0; step <= 20; ++step) {
      const Vec3 tip = path::tip_at(m, step / 20.0), axis = path::axis_at(m, step / 20.0), u = axis.unitOrthogonal(),
                 v = axis.cross(u);
      const auto look = [&](const tool::Frustum& f, double round) {
        for (int i = 0; i <= 8; ++i)
          for (int j = 0; j < 16; ++j) {
            const double h = f.from + (f.to - f.from) * i / 8,
                         r = f.radius_from + (f.radius_to - f.radius_from) * i / 8;
            const Vec3 p = tip + h * axis + r * (std::cos(j * kPi / 8) * u + std::sin(j * kPi / 8) * v);
            least = std::min(least, radius(p) - round);
          }
      };
      look(tool.cutting.front().core, tool.cutting.front().round);
      for (const tool::Frustum& f : tool.bodies) look(f, 0);
    }
    return least;
  };
  test::Random random(7);
  int clear = 0, hit = 0;
  for (int k = 0; k < 300; ++k) {
    const double r = random(79.6, 81), phi = random(-3.1, 3.1), lean = random(-0.4, 0.4), up = random(-0.3, 0.3),
                 turn = random(0, 0.1);
    path::ToolMotion m;
    m.rapid = true;
    m.tip_from = {r * std::cos(phi), r * std::sin(phi), random(-10, 10)};
    m.axis_from = Vec3(std::cos(phi + lean), std::sin(phi + lean), up).normalized();
    m.tip_to = turned(m.tip_from, turn);
    m.axis_to = turned(m.axis_from, turn);
    const bool proven = proof::prove_rapid(m, tool, kCylinder).clear;
    const double least = least_radius(m);
    if (proven) { EXPECT_GE(least, kCylinder.outer_radius_mm - 1e-6) << k; }
    if (least > kCylinder.outer_radius_mm + 0.15) { EXPECT_TRUE(proven) << k << " " << least; }
    clear += proven;
    hit += least < kCylinder.outer_radius_mm;
  }
  EXPECT_GE(clear, 100);
  EXPECT_GE(hit, 60);
}

/// No sampled place of a body lies lower than the bound, for teeth on a plane, a cylinder and cones that open either
/// way; and the bound is not far below the lowest of them where the body stands upright.
TEST(Roof, LiesBelowEveryPlaceOfABody) {
  test::Random random(3);
  for (const double angle : {0.0, 0.4, 0.5 * kPi, 2.1})
    for (int n = 0; n < 200; ++n) {
      const tooth_space::Chart chart{std::cos(angle), std::sin(angle)};
      const proof::Roof roof(chart, 40);
      const tool::RoundedFrustum body{{random(0, 5), random(6, 30), random(0.2, 6), random(0.2, 9), tool::Body::holder},
                                      0};
      const Vec3 tip = random.vector(60);
      const Vec3 axis = n % 2 == 0 ? chart.up_at(azimuth(tip)) : random.vector(1).normalized();
      const double told = roof.over(body, tip, axis);
      const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
      double lowest = INFINITY;
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; j < 24; ++j) {
          const double t = i / 20.0, h = body.core.from + t * (body.core.to - body.core.from),
                       r = body.core.radius_from + t * (body.core.radius_to - body.core.radius_from), a = j * kPi / 12;
          lowest = std::min(lowest, chart.up(Vec3(tip + h * axis + r * (std::cos(a) * u + std::sin(a) * v))) - 40);
        }
      EXPECT_LE(told, lowest + 1e-9) << angle << " " << n;
      if (n % 2 == 0) { EXPECT_GT(told, lowest - 2.5 * body.widest()) << angle << " " << n; }
    }
}

}  // namespace
}  // namespace toothpath
