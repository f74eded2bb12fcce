// The mesh distance against brute force over all triangles: random triangles, slivers, solids, and every body of a
// tool.
#include "cam/clearance/distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "cam/clearance/assembly_gaps.h"
#include "cam/clearance/facet_tree.h"
#include "cam/clearance/frustum_triangle.h"
#include "tests/cam/clearance/shapes.h"
#include "tests/support/plain_frustum.h"
#include "tests/support/sample_tools.h"

namespace toothpath {
namespace {

using test::Random;
using test::stubby_mill;

/// Distance of a point to a triangle by the regions of its corners and edges (Ericson), shared with nobody.
double reference_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long P = p.cast<long double>(), A = a.cast<long double>(), B = b.cast<long double>(), C = c.cast<long double>();
  const auto edge = [&](const Long& s, const Long& e) {
    const Long d = e - s;
    const long double l = d.squaredNorm();
    long double t = l > 0 ? (P - s).dot(d) / l : 0;
    t = std::min<long double>(1, std::max<long double>(0, t));
    return (P - s - t * d).norm();
  };
  long double best = std::min({edge(A, B), edge(B, C), edge(C, A)});
  const Long n = (B - A).cross(C - A);
  if (n.squaredNorm() > 0) {
    const bool inside =
        (B - A).cross(P - A).dot(n) >= 0 && (C - B).cross(P - B).dot(n) >= 0 && (A - C).cross(P - C).dot(n) >= 0;
    if (inside) best = std::min(best, std::abs((P - A).dot(n)) / n.norm());
  }
  return double(best);
}

double brute_distance(const mesh::TriangleMesh& mesh, const Vec3& p) {
  double best = INFINITY;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    best = std::min(best, reference_distance(p, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
  return best;
}

/// Least distance between a triangle and a convex body, by halving the triangle; within `resolution`.
double halved(const Vec3& a, const Vec3& b, const Vec3& c, const tool::Frustum& f, const Vec3& tip, const Vec3& axis,
              double best, double resolution) {
  const Vec3 m = (a + b + c) / 3;
  const double size = std::max({(a - m).norm(), (b - m).norm(), (c - m).norm()}),
               d = test::distance_to_frustum(m, f, tip, axis);
  best = std::min(best, d);
  if (best <= resolution || d - size >= best - resolution) return best;
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  best = halved(ab, bc, ca, f, tip, axis, best, resolution);
  best = halved(a, ab, ca, f, tip, axis, best, resolution);
  best = halved(ab, b, bc, f, tip, axis, best, resolution);
  return halved(ca, bc, c, f, tip, axis, best, resolution);
}

TEST(MeshDistance, PointsAgreeWithBruteForce) {
  Random random(1);
  for (const std::size_t count :
       {std::size_t(1), std::size_t(7), std::size_t(8), std::size_t(9), std::size_t(60), std::size_t(1000)}) {
    const mesh::TriangleMesh mesh = test::scattered(random, count, 20, 4);
    const clearance::MeshDistance distance(mesh);
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = random.vector(30);
      const double expected = brute_distance(mesh, p);
      const clearance::MeshPlace place = distance.nearest(p, 1e3);
      ASSERT_NEAR(place.distance, expected, 1e-9) << count << " triangles";
      ASSERT_GE(place.triangle, 0);
      const auto t = std::size_t(place.triangle);
      EXPECT_NEAR(reference_distance(p, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)), expected, 1e-9);
      EXPECT_NEAR((place.foot - p).norm(), expected, 1e-9);
      EXPECT_EQ(distance.nearest(p, 0.5 * expected).distance, 0.5 * expected) << "nothing within the limit";
      EXPECT_EQ(distance.nearest(p, 0.5 * expected).triangle, -1);
    }
  }
}

TEST(MeshDistance, EmptyMeshIsFarAway) {
  const clearance::MeshDistance distance{mesh::TriangleMesh{}};
  EXPECT_EQ(distance.nearest(Vec3::Zero(), 7).distance, 7);
  EXPECT_FALSE(distance.inside(Vec3::Zero()));
  EXPECT_EQ(distance.to_frustum({0, 1, 1, 1, tool::Body::shank}, Vec3::Zero(), Vec3::UnitZ(), 3).distance, 3);
}

TEST(MeshDistance, SliversAndPointsAreNoExceptions) {
  Random random(2);
  mesh::TriangleMesh mesh;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto n = std::int32_t(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({n, n + 1, n + 2});
  };
  for (int k = 0; k < 300; ++k) {
    const Vec3 a = random.vector(10), d = random.vector(5);
    const double width = std::pow(10.0, random(-14, -2));
    switch (k % 4) {
      case 0: add(a, a + d, a + random(0, 1) * d + random.vector(width)); break;  // needle
      case 1: add(a, a + d, a + 2 * d); break;                                    // a line
      case 2: add(a, a, a + d); break;                                            // an edge twice
      default: add(a, a, a);                                                      // a point
    }
  }
  const clearance::MeshDistance distance(mesh);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p = random.vector(15);
    ASSERT_NEAR(distance.nearest(p, 100).distance, brute_distance(mesh, p), 1e-7);
  }
}

TEST(MeshDistance, PathsGiveWhatSinglePointsGive) {
  Random random(3);
  const mesh::TriangleMesh mesh = test::scattered(random, 800, 15, 1);
  const clearance::MeshDistance distance(mesh);
  std::vector<Vec3> path;
  for (int pass = 0; pass < 40; ++pass) {
    Vec3 p = random.vector(20);
    const Vec3 step = random.vector(1).normalized() * (pass % 2 ? 0.1 : random(0, 3));
    for (int k = 0; k < 37; ++k, p += step) path.push_back(p);
  }
  std::vector<double> found(path.size());
  distance.nearest_along(path, 2.5, found);
  for (std::size_t k = 0; k < path.size(); ++k)
    ASSERT_NEAR(found[k], std::min(2.5, brute_distance(mesh, path[k])), 1e-9) << k;
}

TEST(MeshDistance, InsideIsToldByParity) {
  Random random(4);
  const mesh::TriangleMesh ball = test::ball(Vec3(3, -2, 5), 10, 24), box = test::box(Vec3(-4, -5, -6), Vec3(7, 8, 9));
  const clearance::MeshDistance in_ball(ball), in_box(box);
  int inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 p = random.vector(12), q = Vec3(3, -2, 5) + random.vector(12);
    const bool expected = (p.array() > Eigen::Array3d(-4, -5, -6)).all() && (p.array() < Eigen::Array3d(7, 8, 9)).all();
    EXPECT_EQ(in_box.inside(p), expected);
    const double r = (q - Vec3(3, -2, 5)).norm();
    if (r < 9.7) { EXPECT_TRUE(in_ball.inside(q)); }
    if (r > 10) { EXPECT_FALSE(in_ball.inside(q)); }
    inside += r < 9.7;
  }
  EXPECT_GT(inside, 500);
  // Whole numbers, where rays meet corners and edges.
  for (int x = -3; x < 7; ++x) EXPECT_TRUE(in_box.inside(Vec3(x, 0, 0)));
}

TEST(MeshDistance, FrustumAndTriangleAreBoundedFromBothSides) {
  Random random(5);
  double widest = 0;
  int touching = 0, apart = 0;
  for (int k = 0; k < 250; ++k) {
    const Vec3 a = random.vector(6);
    const double size = std::pow(10.0, random(-3, 1.5));
    const clearance::TriangleCorners t{a, a + random.vector(size),
                                       k % 7 == 0 ? Vec3(a + random.vector(1e-9)) : Vec3(a + random.vector(size))};
    const tool::Frustum f{random(0, 2), random(2.1, 9), random(0.1, 4), random(0.1, 4), tool::Body::holder};
    const Vec3 tip = random.vector(3), axis = random.vector(1).normalized();
    const clearance::FrustumGap gap = clearance::frustum_to_triangle(f, tip, axis, t, INFINITY);
    const double brute = halved(t.a, t.b, t.c, f, tip, axis, INFINITY, 2e-3);
    if (gap.distance > 0) {
      ++apart;
      widest = std::max(widest, gap.above - gap.distance);
      ASSERT_LE(gap.distance, brute + 1e-10) << k;
      ASSERT_GE(gap.above, brute - 2.1e-3) << k;
      ASSERT_NEAR(test::distance_to_frustum(gap.foot, f, tip, axis), gap.above, 1e-9 + gap.above - gap.distance);
    } else {
      ++touching;
      ASSERT_LE(brute, 2e-3) << k;
    }
    const double enough = 0.5 * brute;
    if (brute > 1e-3) { EXPECT_GE(clearance::frustum_to_triangle(f, tip, axis, t, enough).distance, enough); }
  }
  EXPECT_LT(widest, 1e-7);
  EXPECT_GT(touching, 15);
  EXPECT_GT(apart, 100);
}

TEST(MeshDistance, FrustumAgainstMeshAgreesWithBruteForce) {
  Random random(6);
  const mesh::TriangleMesh mesh = test::scattered(random, 300, 20, 3);
  const clearance::MeshDistance distance(mesh);
  for (int k = 0; k < 120; ++k) {
    const tool::Frustum f{random(0, 2), random(2.1, 9), random(0.1, 4), random(0.1, 4), tool::Body::holder};
    const Vec3 tip = random.vector(25), axis = random.vector(1).normalized();
    double brute = INFINITY;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      brute = halved(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), f, tip, axis, brute, 2e-3);
    const clearance::MeshPlace place = distance.to_frustum(f, tip, axis, 5);
    ASSERT_NEAR(place.distance, std::min(brute, 5.0), 2.1e-3);
    ASSERT_LE(place.distance, brute + 1e-9);
    if (brute < 5 && brute > 2e-3) {
      EXPECT_NEAR(test::distance_to_frustum(place.foot, f, tip, axis), place.distance, 1e-6);
    }
  }
}

TEST(MeshDistance, SegmentAgreesWithSamples) {
  Random random(7);
  const mesh::TriangleMesh mesh = test::scattered(random, 400, 20, 3);
  const clearance::MeshDistance distance(mesh);
  for (int k = 0; k < 40; ++k) {
    const Vec3 from = random.vector(20), axis = random.vector(1).normalized();
    const double height = random(0.5, 12), found = distance.to_segment(from, axis, height, 100).distance;
    double sampled = INFINITY;
    for (int n = 0; n <= 100; ++n) sampled = std::min(sampled, brute_distance(mesh, from + n * height / 100 * axis));
    EXPECT_LE(found, sampled + 1e-9);
    EXPECT_GE(found, sampled - height / 200 - 1e-9);
  }
}

/// Every processor gets the same bits.
TEST(MeshDistance, KernelsAgreeBitForBit) {
  Random random(8);
  const mesh::TriangleMesh mesh = test::scattered(random, 2000, 20, 2);
  const clearance::MeshDistance distance(mesh);
  const clearance::TreeView tree = distance.view();
  const clearance::MeshKernels &fast = clearance::mesh_kernels(), &plain = clearance::plain_mesh_kernels();
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = random.vector(20), axis = random.vector(1).normalized();
    const clearance::TriangleHit a = fast.nearest(tree, p.data(), 1e4, {}), b = plain.nearest(tree, p.data(), 1e4, {});
    ASSERT_EQ(std::memcmp(&a.squared, &b.squared, sizeof(double)), 0);
    ASSERT_EQ(a.block, b.block);
    ASSERT_EQ(a.lane, b.lane);
    const clearance::CapsuleView s{{p.x(), p.y(), p.z()}, {axis.x(), axis.y(), axis.z()}, 4};
    std::vector<std::int32_t> x(4000), y(4000);
    const std::size_t n = fast.gather(tree, s, 3, x.data(), x.size());
    ASSERT_EQ(n, plain.gather(tree, s, 3, y.data(), y.size()));
    ASSERT_EQ(x, y);
    clearance::MeshWindow window;
    window.gather(tree, s, 3);
    std::vector<std::int64_t> u(4000), v(4000);
    ASSERT_EQ(fast.beside_flute(tree, window.groups(), window.size(), s, 4, u.data(), u.size()),
              plain.beside_flute(tree, window.groups(), window.size(), s, 4, v.data(), v.size()));
    ASSERT_EQ(u, v);
    const double c = fast.along(tree, s, 4), d2 = plain.along(tree, s, 4);
    ASSERT_EQ(std::memcmp(&c, &d2, sizeof(double)), 0);
    const clearance::FrustumView f = clearance::frustum_view({1, 5, 1, 3, tool::Body::holder}, p, axis);
    alignas(64) double d[clearance::kLanes], e[clearance::kLanes];
    fast.frustum_to_boxes(tree.nodes[0], f, d);
    plain.frustum_to_boxes(tree.nodes[0], f, e);
    ASSERT_EQ(std::memcmp(d, e, sizeof d), 0);
    fast.frustum_to_triangles(tree.blocks[0], f, d);
    plain.frustum_to_triangles(tree.blocks[0], f, e);
    ASSERT_EQ(std::memcmp(d, e, sizeof d), 0);
    const clearance::RayView ray{
        {p.x(), p.y(), p.z()}, {axis.x(), axis.y(), axis.z()}, {1 / axis.x(), 1 / axis.y(), 1 / axis.z()}};
    ASSERT_EQ(fast.ray_to_boxes(tree.nodes[0], ray), plain.ray_to_boxes(tree.nodes[0], ray));
    for (const clearance::TriangleBlock& block : distance.tree().blocks()) {
      const clearance::RayLanes by_fast = fast.ray_to_triangles(block, ray),
                                by_plain = plain.ray_to_triangles(block, ray);
      ASSERT_EQ(by_fast.through, by_plain.through);
      ASSERT_EQ(by_fast.near_edge, by_plain.near_edge);
      ASSERT_EQ(by_fast.edge_on, by_plain.edge_on);
    }
  }
}

/// The assembly along paths, against the bodies one by one without any coherence.
TEST(MeshAssembly, PosesAgreeWithSingleQuestions) {
  Random random(9);
  const mesh::TriangleMesh mesh = test::scattered(random, 1500, 25, 1.5);
  const clearance::MeshDistance distance(mesh);
  const tool::ToolAssembly tool = stubby_mill();
  const double within = 0.5;
  int cut = 0, struck = 0, free = 0;
  for (int pass = 0; pass < 30; ++pass) {
    std::vector<clearance::ToolPose> poses;
    Vec3 tip = random.vector(30), axis = random.vector(1).normalized();
    const Vec3 step = random.vector(1).normalized() * (pass % 3 == 0 ? 2.0 : 0.1),
               turn = random.vector(pass % 2 ? 0.0 : 0.01);
    for (int k = 0; k < 50; ++k, tip += step, axis = (axis + turn).normalized()) poses.push_back({tip, axis});
    clearance::MeshAssembly assembly(distance, tool, within);
    const std::size_t n = assembly.bodies();
    ASSERT_EQ(n, 4u);
    std::vector<double> gaps(poses.size() * n);
    assembly.gaps(poses, gaps);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Vec3 c = poses[k].tip + tool.radius_mm() * poses[k].axis;
      const double height = tool.flute_length_mm - tool.radius_mm();
      double axis_distance = INFINITY;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Vec3 foot;
        axis_distance = std::min(axis_distance, clearance::segment_to_triangle(
                                                    c, poses[k].axis, height,
                                                    {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, foot));
      }
      const double cutter = std::min(std::sqrt(axis_distance) - tool.radius_mm(), within);
      if (std::isfinite(gaps[k * n])) { ASSERT_NEAR(gaps[k * n], cutter, 1e-9) << pass << " " << k; }
      cut += cutter < 0;
      const auto bodies = tool::shank_and_holder(tool);
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        const double expected = distance.to_frustum(bodies[b], poses[k].tip, poses[k].axis, within).distance;
        if (std::isfinite(gaps[k * n + 1 + b])) {
          ASSERT_NEAR(gaps[k * n + 1 + b], expected, 1e-9) << pass << " " << k << " " << b;
        }
        struck += expected <= 0;
        free += expected >= within;
      }
    }
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(struck, 150);
  EXPECT_GT(free, 150);
}

/// A tool wholly inside a solid has no surface near it, on a path that starts there and on one that jumps there.
TEST(MeshAssembly, ToolInsideTheSolidIsFound) {
  const mesh::TriangleMesh mesh = test::box(Vec3(-100, -100, -100), Vec3(100, 100, 100));
  const clearance::MeshDistance distance(mesh);
  clearance::MeshAssembly assembly(distance, stubby_mill(), 0.5);
  const std::size_t n = assembly.bodies();
  std::vector<clearance::ToolPose> poses = {{Vec3(0, 0, 0), Vec3::UnitZ()},
                                            {Vec3(0.1, 0, 0), Vec3::UnitZ()},
                                            {Vec3(0, 0, 150), Vec3::UnitZ()},
                                            {Vec3(0, 0, 20), Vec3::UnitZ()},
                                            {Vec3(0, 0, 96.2), Vec3::UnitZ()}};
  std::vector<double> gaps(poses.size() * n);
  assembly.gaps(poses, gaps);
  for (std::size_t b = 0; b < n; ++b) {
    EXPECT_EQ(gaps[b], -INFINITY);
    EXPECT_EQ(gaps[n + b], -INFINITY);
    EXPECT_EQ(gaps[2 * n + b], 0.5);
    EXPECT_EQ(gaps[3 * n + b], -INFINITY);
  }
  EXPECT_NEAR(gaps[4 * n], -1, 1e-9) << "the axis of the cutter passes through the face";
  EXPECT_NEAR(gaps[4 * n + 1], 0.2, 1e-9) << "the shank begins at 100.2, above the face";
}

// Whose facets lie near: all of them and no others, few or many, triangles and segments.
TEST(FacetTree, TellsWhoseFacetsLieNear) {
  Random random(31);
  std::vector<clearance::Facet> facets;
  for (std::uint32_t k = 0; k < 3000; ++k) {
    const Vec3 a(random(-5, 5), random(-5, 5), random(-5, 5));
    const Vec3 b = a + Vec3(random(-1, 1), random(-1, 1), random(-1, 1));
    const Vec3 c = k % 3 == 0 ? b : Vec3(a + Vec3(random(-1, 1), random(-1, 1), random(-1, 1)));
    facets.push_back({{a, b, c}, k / 2});
  }
  const clearance::FacetTree tree(facets);
  for (int asked = 0; asked < 200; ++asked) {
    const Vec3 p(random(-6, 6), random(-6, 6), random(-6, 6));
    const double within = random(0, 4), slack = asked % 5 == 0 ? INFINITY : random(0, 0.5);
    std::vector<double> truth;
    for (const auto& f : facets) truth.push_back(reference_distance(p, f.corner[0], f.corner[1], f.corner[2]));
    const double least = *std::min_element(truth.begin(), truth.end());
    EXPECT_NEAR(tree.least(p, within), std::min(least, within), 1e-9);
    std::vector<int> seen(facets.size() / 2, 0), wanted = seen, allowed = seen;
    const double told = tree.near(p, within, slack, [&](std::size_t owner, double d) {
      ++seen[owner];
      EXPECT_NEAR(std::min(std::abs(d - truth[2 * owner]), std::abs(d - truth[2 * owner + 1])), 0, 1e-9);
    });
    if (least < within) { EXPECT_NEAR(told, least, 1e-9); }
    if (least > within) { EXPECT_EQ(told, INFINITY); }
    const double reach = std::min(within, least + slack);
    for (std::size_t k = 0; k < facets.size(); ++k) {
      wanted[k / 2] += truth[k] < reach - 1e-9;
      allowed[k / 2] += truth[k] < reach + 1e-9;
    }
    for (std::size_t owner = 0; owner < seen.size(); ++owner) {
      EXPECT_TRUE(seen[owner] > 0 || wanted[owner] == 0) << owner;
      EXPECT_TRUE(seen[owner] == 0 || allowed[owner] > 0) << owner;
    }
  }
  EXPECT_EQ(clearance::FacetTree().least(Vec3::Zero(), 3), 3) << "none";
}

// A line keeps no more than the distance of any of its places, and all of it from facets that lie behind its start.
TEST(FacetTree, LinesKeepBelowTheTruth) {
  Random random(41);
  int exact = 0, near = 0;
  for (int asked = 0; asked < 300; ++asked) {
    std::vector<clearance::Facet> facets;
    for (std::uint32_t k = 0; k < 60; ++k) {
      const Vec3 a(random(-5, 5), random(-5, 5), random(-5, 5));
      const Vec3 b = a + random.vector(1);
      facets.push_back({{a, b, k % 3 == 0 ? b : Vec3(a + random.vector(1))}, k});
    }
    const clearance::FacetTree tree(facets);
    const Vec3 from = random.vector(5), axis = random.vector(1).normalized();
    const double length = asked % 7 == 0 ? 0 : random(0, 6), within = random(0.5, 4);
    double truth = INFINITY, start = INFINITY, across = INFINITY;
    for (const auto& f : facets) {
      Vec3 foot;
      const auto line = [&](double from_h, double to_h) {
        return std::sqrt(clearance::segment_to_triangle(from + from_h * axis, axis, to_h - from_h,
                                                        {f.corner[0], f.corner[1], f.corner[2]}, foot));
      };
      truth = std::min(truth, line(0, length));
      start = std::min(start, reference_distance(from, f.corner[0], f.corner[1], f.corner[2]));
      across = std::min(across, line(-20, 20));
    }
    const double told = tree.least_along(from, axis, length, within);
    EXPECT_LE(told, std::min(truth, within) + 1e-9);
    EXPECT_GE(told, std::min({across, start, within}) - 1e-9);
    exact += truth < within && told > truth - 1e-9;
    near += truth < within;
  }
  EXPECT_GT(near, 200);
  EXPECT_GT(exact, near / 2);
  EXPECT_EQ(clearance::FacetTree().least_along(Vec3::Zero(), Vec3::UnitX(), 2, 3), 3) << "none";
}

}  // namespace
}  // namespace toothpath
