// Finger mills against meshes: the truncated cones enclose the cutter closely, and no sampling of a motion comes nearer
// than what is proven.
#include "cam/finger/bodies.h"
#include "cam/finger/obstacles.h"

#include <algorithm>

#include "tests/cam/clearance/shapes.h"
#include "tests/cam/finger/jobs.h"
#include "tests/support/plain_frustum.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using test::Random;

TEST(FingerBodies, PiecesEncloseTheCutterClosely) {
  Random random(3);
  for (const Designed& d : {Designed{w3(), pinion_mill()}, Designed{w4(), wheel_mill()}, design(9, 40, 3, 20, 0.25),
                            design(30, 30, 1, 35, 0.2)}) {
    const bevel_gear::BevelGear gear = gear_of(d);
    const bevel_gear::FingerSolid solid(gear.cutter());
    tool::ToolAssembly tool = mill(d.c);
    tool.flute_length_mm = d.p.dedendum_mm + d.c.profile_height_mm + 1;
    const auto bodies = finger::finger_bodies(gear.cutter(), tool);
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_TRUE(bodies[0].cuts());
    EXPECT_EQ(bodies[0].top_mm(), tool.flute_length_mm);
    EXPECT_EQ(bodies[1].pieces.front().from, tool.flute_length_mm) << "shank";
    EXPECT_EQ(bodies[2].pieces.front().from, tool.stick_out_mm) << "holder";
    double most = 0;
    for (int n = 0; n < 4000; ++n) {
      const double height = random(-1, tool.flute_length_mm - 0.5), rho = random(0, 1.5 * gear.cutter().rho_D);
      const double truth = std::max(0.0, solid.signed_distance(height - d.p.dedendum_mm, rho));
      double pieces = INFINITY;
      for (const auto& f : bodies[0].pieces)
        pieces = std::min(pieces, test::distance_to_frustum(Vec3(rho, 0, height), f, Vec3::Zero(), Vec3::UnitZ()));
      EXPECT_LE(pieces, truth + 1e-12) << height << " " << rho;
      most = std::max(most, truth - pieces);
    }
    EXPECT_LE(most, std::max(d.c.tip_radius_mm / 800, 1e-3)) << d.p.teeth;
    EXPECT_LE(bodies[0].pieces.size(), 50u);
  }
}

// Hulls and cones are of one profile: without a holder both end at the gauge line.
TEST(FingerBodies, HullsAndConesEndAtTheSamePlaces) {
  const bevel_gear::BevelGear gear = made(w3(), pinion_mill());
  for (const bool held : {true, false}) {
    tool::ToolAssembly tool = mill(pinion_mill());
    tool.stick_out_mm = 22;
    tool.length_mm = 60;
    tool.holder.clear();
    if (held) tool.holder = {{16, 20, 10}, {20, 24, 5}};
    const tool::Profile profile = finger::finger_profile(gear.cutter(), tool, 1e-3);
    const auto hulls = finger::tool_hulls(profile);
    const auto cones = tool::shank_and_holder(profile);
    ASSERT_EQ(hulls.size(), held ? 3u : 2u);
    EXPECT_EQ(hulls[0].rims.back().x(), finger::finger_flute_end(gear.cutter(), tool));
    EXPECT_EQ(hulls[1].rims.back().x(), held ? 22 : 60);
    EXPECT_EQ(hulls.back().rims.back(), Vec2(cones.back().to, cones.back().radius_to));
    EXPECT_EQ(cones.size(), held ? 3u : 1u);
  }
}

// Brute force that knows the cutter as a solid and the mesh as points of its surface.
TEST(FingerBodies, ProvenGapAgainstDenseSampling) {
  Random random(12);
  const bevel_gear::BevelGear gear = made(w3(), pinion_mill());
  const bevel_gear::FingerSolid solid(gear.cutter());
  tool::ToolAssembly tool = mill(pinion_mill());
  tool.stick_out_mm = 22;
  tool.holder = {{16, 20, 10}};
  const auto bodies = finger::finger_bodies(gear.cutter(), tool);
  const double h_f = gear.parameters().dedendum_mm, flute = finger::finger_flute_end(gear.cutter(), tool);
  /// Signed in the cutting part below its top, beyond that the cylinder ends.
  const auto gap_of = [&](const Vec3& p, const Vec3& tip, const Vec3& axis) {
    const double x = (p - tip).dot(axis), rho = (p - tip - x * axis).norm();
    const double radius = gear.cutter().rho_D;
    double d = x > flute ? std::hypot(x - flute, std::max(0.0, rho - radius)) : solid.signed_distance(x - h_f, rho);
    const auto cylinder = [&](double from, double to, double r0, double r1) {
      if (x >= from && x <= to && rho <= r0 + (r1 - r0) * (x - from) / (to - from)) d = std::min(d, 0.0);
      const double share = std::clamp(
          ((x - from) * (to - from) + (rho - r0) * (r1 - r0)) / (std::pow(to - from, 2) + std::pow(r1 - r0, 2)), 0.0,
          1.0);
      d = std::min(d, std::hypot(x - from - share * (to - from), rho - r0 - share * (r1 - r0)));
      d = std::min(d, std::hypot(x - from, std::max(0.0, rho - r0)));
      d = std::min(d, std::hypot(x - to, std::max(0.0, rho - r1)));
    };
    cylinder(flute, 22, 5, 5);
    cylinder(22, 32, 8, 10);
    return d;
  };
  int near = 0, struck = 0;
  std::array<int, 3> body{};
  for (int k = 0; k < 80; ++k) {
    const double height = random(-1, 34), size = random(0.3, 1.5), turn = random(0, 2 * kPi);
    const Vec3 middle(random(1, 15) * std::cos(turn), 0, height);
    const mesh::TriangleMesh obstacle = test::box(middle - Vec3::Constant(size), middle + Vec3::Constant(size));
    const clearance::MeshDistance mesh(obstacle);
    const clearance::MeshDistance* meshes[] = {&mesh};
    std::vector<path::ToolMotion> motions;
    Vec3 tip = random.vector(0.5), axis = Vec3::UnitZ();
    for (int n = 0; n < 3; ++n) {
      path::ToolMotion m;
      m.tip_from = tip, m.axis_from = axis;
      tip += random.vector(0.6);
      axis = (axis + random.vector(0.03)).normalized();
      m.tip_to = tip, m.axis_to = axis;
      motions.push_back(m);
    }
    const auto found = clearance::MeshClearance(meshes, {}).nearest(motions, bodies, {0.1, 0.1});
    double dense = INFINITY;
    for (const auto& t : obstacle.triangles)
      for (int i = 0; i <= 10; ++i)
        for (int j = 0; i + j <= 10; ++j) {
          const Vec3 &a = obstacle.vertices[std::size_t(t[0])], &b = obstacle.vertices[std::size_t(t[1])],
                     &c = obstacle.vertices[std::size_t(t[2])];
          const Vec3 p = a + (b - a) * (i / 10.0) + (c - a) * (j / 10.0);
          for (const auto& m : motions)
            for (int s = 0; s <= 8; ++s) {
              const double share = s / 8.0;
              dense = std::min(dense, gap_of(p, m.tip_from + share * (m.tip_to - m.tip_from),
                                             ((1 - share) * m.axis_from + share * m.axis_to).normalized()));
            }
        }
    if (!found) {
      EXPECT_GE(dense, 2.1 - 1e-9) << k;
      continue;
    }
    EXPECT_LE(found->gap_mm, std::max(dense, 0.0) + 1e-9) << k;
    if (found->gap_mm > 0) {
      ++near;
      EXPECT_GE(found->gap_mm, 0.9 * dense - 0.17) << k << ": points of the mesh are up to 0.3 apart";
    } else {
      ++struck;
    }
    ++body[found->body == tool::Body::cutter ? 0 : found->body == tool::Body::shank ? 1 : 2];
  }
  EXPECT_GE(near, 10);
  EXPECT_GT(struck, 15);
  for (const int count : body) EXPECT_GT(count, 5);
}

TEST(FingerBodies, DrawnBackTheMillPassesWhereItWas) {
  const bevel_gear::BevelGear gear = made(w3(), pinion_mill());
  const tool::ToolAssembly tool = mill(pinion_mill());
  const auto bodies = finger::finger_bodies(gear.cutter(), tool);
  const double top = finger::finger_flute_end(gear.cutter(), tool);  // 9.9
  const clearance::MeshDistance plate(test::box(Vec3(-20, -20, 1), Vec3(20, 20, top - 2))),
      lid(test::box(Vec3(-20, -20, top + 1), Vec3(20, 20, top + 1.5)));
  path::ToolMotion back;
  back.tip_to = Vec3(0, 0, 5);
  back.axis_from = back.axis_to = Vec3::UnitZ();
  const clearance::Withdrawal w{Vec3::Zero(), Vec3::UnitZ()};
  const clearance::MeshRule only_cutter{0, 0, true, false};
  const clearance::MeshDistance* plates[] = {&plate};
  const auto cut = clearance::MeshClearance(plates, {}).nearest(std::span(&back, 1), bodies, only_cutter);
  ASSERT_TRUE(cut);
  EXPECT_LE(cut->gap_mm, 0);
  const auto credited = clearance::MeshClearance(plates, {}).nearest(std::span(&back, 1), bodies, only_cutter, w);
  if (credited) { EXPECT_GT(credited->gap_mm, 1.9); }
  const clearance::MeshDistance* lids[] = {&lid};
  const auto struck = clearance::MeshClearance(lids, {}).nearest(std::span(&back, 1), bodies, only_cutter, w);
  ASSERT_TRUE(struck);
  EXPECT_LE(struck->gap_mm, 0);
}

}  // namespace
}  // namespace toothpath
