// Clearance of motions from a mesh: the proven gap against sampling ten times denser, and what a withdrawal may pass.
#include "cam/clearance/clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cam/clearance/shapes.h"
#include "tests/support/sample_tools.h"

namespace toothpath {
namespace {

using test::Random;
using test::stubby_mill;

path::ToolMotion motion(const Vec3& a, const Vec3& b, const Vec3& u = Vec3::UnitZ(), const Vec3& v = Vec3::UnitZ()) {
  path::ToolMotion m;
  m.tip_from = a;
  m.tip_to = b;
  m.axis_from = u;
  m.axis_to = v;
  return m;
}

/// Least gap over samples of the motions, every body.
double sampled(const clearance::MeshDistance& mesh, std::span<const path::ToolMotion> motions,
               const tool::ToolAssembly& tool, int samples) {
  double least = INFINITY;
  const double R = tool.radius_mm();
  for (const auto& m : motions)
    for (int k = 0; k <= samples; ++k) {
      const double t = double(k) / samples;
      const Vec3 tip = (1 - t) * m.tip_from + t * m.tip_to, axis = ((1 - t) * m.axis_from + t * m.axis_to).normalized();
      least = std::min(
          least, std::max(0.0, mesh.to_segment(tip + R * axis, axis, tool.flute_length_mm - R, 100).distance - R));
      for (const auto& body : tool::shank_and_holder(tool))
        least = std::min(least, mesh.to_frustum(body, tip, axis, 100).distance);
    }
  return least;
}

TEST(MeshClearance, BoundHoldsBetweenTheSamples) {
  Random random(11);
  int near = 0, struck = 0, free = 0;
  for (int k = 0; k < 80; ++k) {
    const mesh::TriangleMesh obstacle = test::ball(random.vector(9), random(0.5, 6), 6);
    const clearance::MeshDistance mesh(obstacle);
    const clearance::MeshDistance* meshes[] = {&mesh};
    clearance::MeshClearanceOptions options;
    options.proof_mm = 0.02;
    const clearance::MeshClearance clearance(meshes, options);
    std::vector<path::ToolMotion> motions;
    Vec3 tip = random.vector(12), axis = random.vector(1).normalized();
    for (int n = 0; n < 5; ++n) {
      const Vec3 next = tip + random.vector(2), turned = (axis + random.vector(0.1)).normalized();
      motions.push_back(motion(tip, next, axis, turned));
      tip = next;
      axis = turned;
    }
    const auto found = clearance.nearest(motions, stubby_mill(), {0.1, 0.1});
    const double dense = sampled(mesh, motions, stubby_mill(), 40);
    if (!found) {
      ++free;
      EXPECT_GE(dense, 0.1 + options.look_mm - 1e-9);
    } else if (found->gap_mm <= 0) {
      ++struck;
      EXPECT_LE(dense, 0.05) << k;
    } else {
      ++near;
      EXPECT_LE(found->gap_mm, dense + 1e-9) << k;
      EXPECT_GE(found->measured_mm, dense - 0.05) << k;
      EXPECT_GE(found->gap_mm, 0.9 * dense - 0.05) << k;
    }
  }
  EXPECT_GT(near, 10);
  EXPECT_GT(struck, 5);
  EXPECT_GT(free, 10);
}

TEST(MeshClearance, SeesAWallThinnerThanTheStep) {
  const clearance::MeshDistance wall(test::box(Vec3(20, -1, -50), Vec3(20.01, 1, 50)));
  const clearance::MeshDistance* meshes[] = {&wall};
  const clearance::MeshClearance clearance(meshes, {});
  const path::ToolMotion pass[] = {motion(Vec3(0, 0, 0), Vec3(100, 0, 0))};
  const auto found = clearance.nearest(pass, stubby_mill(), {0.05, 0.05});
  ASSERT_TRUE(found);
  EXPECT_LE(found->gap_mm, 0);
}

TEST(MeshClearance, ToolInsideIsNotClear) {
  const clearance::MeshDistance block(test::box(Vec3(-100, -100, -100), Vec3(100, 100, 100)));
  const clearance::MeshDistance* meshes[] = {&block};
  const path::ToolMotion pass[] = {motion(Vec3(0, 0, 0), Vec3(1, 0, 0))};
  const auto found = clearance::MeshClearance(meshes, {}).nearest(pass, stubby_mill(), {0.05, 0.05});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->measured_mm, -INFINITY);
}

TEST(MeshClearance, DrawnBackAlongItsAxisTheCutterPassesWhereItWas) {
  // A plate 3 mm thick that the flute (4 mm) has cut into, and a lid above the flute that it has not.
  const clearance::MeshDistance plate(test::box(Vec3(-20, -20, 0), Vec3(20, 20, 3))),
      lid(test::box(Vec3(-20, -20, 6), Vec3(20, 20, 7)));
  const path::ToolMotion back[] = {motion(Vec3(0, 0, 0.5), Vec3(0, 0, 4.0))};
  const clearance::Withdrawal w{Vec3(0, 0, 0.5), Vec3::UnitZ()};
  ASSERT_TRUE(clearance::draws_back(back[0], w));
  EXPECT_FALSE(clearance::draws_back(motion(Vec3(0, 0, 0.5), Vec3(0.01, 0, 4)), w)) << "aside";
  EXPECT_FALSE(clearance::draws_back(motion(Vec3(0, 0, 0.5), Vec3(0, 0, 0.2)), w)) << "deeper";
  EXPECT_FALSE(
      clearance::draws_back(motion(Vec3(0, 0, 0.5), Vec3(0, 0, 4), Vec3::UnitZ(), Vec3(0.01, 0, 1).normalized()), w))
      << "tilted";
  tool::ToolAssembly tool = stubby_mill();
  tool.stick_out_mm = 30;
  const clearance::MeshRule rule{0, 0};
  const clearance::MeshDistance* plates[] = {&plate};
  const auto cut = clearance::MeshClearance(plates, {}).nearest(back, tool, rule);
  ASSERT_TRUE(cut);
  EXPECT_LE(cut->gap_mm, 0) << "without credit it touches";
  const auto credited = clearance::MeshClearance(plates, {}).nearest(back, tool, rule, w);
  ASSERT_TRUE(credited);
  EXPECT_GT(credited->gap_mm, 1) << "the old top of the flute was at 4.5, the plate ends at 3";
  const clearance::MeshDistance* lids[] = {&lid};
  const auto struck = clearance::MeshClearance(lids, {}).nearest(back, tool, rule, w);
  ASSERT_TRUE(struck);
  EXPECT_LE(struck->gap_mm, 0) << "the flute comes up into the lid";
}

}  // namespace
}  // namespace toothpath
