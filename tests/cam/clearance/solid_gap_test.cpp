// Gaps between solids and what reaches out of others, against shapes whose answer is known by hand.
#include "cam/clearance/solid_gap.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/cam/clearance/shapes.h"

namespace toothpath::test {
namespace {

using clearance::MeshDistance;

mesh::TriangleMesh turned_about_x(mesh::TriangleMesh mesh, double angle) {
  for (auto& v : mesh.vertices)
    v = Vec3(v.x(), std::cos(angle) * v.y() - std::sin(angle) * v.z(),
             std::sin(angle) * v.y() + std::cos(angle) * v.z());
  return mesh;
}

double gap(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b, double within = 1000) {
  const MeshDistance of_a(a), of_b(b);
  const double gap = clearance::surface_gap({a, of_a}, {b, of_b}, within);
  EXPECT_NEAR(gap, clearance::surface_gap({b, of_b}, {a, of_a}, within), 1e-12);
  return gap;
}

TEST(SolidGap, OfShapesByHand) {
  const mesh::TriangleMesh cube = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  EXPECT_NEAR(gap(cube, box(Vec3(3.5, -9, -9), Vec3(5, 9, 9))), 2.5, 1e-12) << "faces";
  EXPECT_NEAR(gap(cube, box(Vec3(4, 5, 1), Vec3(6, 7, 2))), 5, 1e-12) << "edges";
  EXPECT_NEAR(gap(cube, box(Vec3(3, 4, 7), Vec3(6, 7, 8))), 7, 1e-12) << "corners";
  EXPECT_NEAR(gap(cube, box(Vec3(-4, -5, -6), Vec3(4, 5, 6))), 3, 1e-12) << "one in the other";
  EXPECT_EQ(gap(cube, box(Vec3(0.5, -9, -9), Vec3(5, 9, 9))), 0) << "they meet";
  EXPECT_NEAR(gap(cube, box(Vec3(-0.2, -0.2, -9), Vec3(0.2, 0.2, 9))), 0, 1e-12)
      << "a pin through it, no corner in the other";
  EXPECT_EQ(gap(cube, box(Vec3(300, -1, -1), Vec3(301, 1, 1)), 12), 12) << "not told beyond the limit";
  // Two edges across each other: bars of square section on their corners.
  const mesh::TriangleMesh bar = turned_about_x(box(Vec3(-9, -1, -1), Vec3(9, 1, 1)), M_PI / 4);
  mesh::TriangleMesh across = bar;
  for (auto& v : across.vertices) v = Vec3(v.y(), v.x(), v.z() + 4);
  for (auto& t : across.triangles) std::swap(t[1], t[2]);
  EXPECT_NEAR(gap(bar, across), 4 - 2 * std::sqrt(2.0), 1e-12);
}

clearance::OutsidePlace outside(const mesh::TriangleMesh& part, const std::vector<mesh::TriangleMesh>& solids) {
  std::vector<std::unique_ptr<MeshDistance>> owned;
  std::vector<const MeshDistance*> all;
  for (const auto& s : solids) all.push_back(owned.emplace_back(std::make_unique<MeshDistance>(s)).get());
  return clearance::farthest_outside(part, std::vector<bool>(part.vertices.size(), true), all, 0.1);
}

TEST(SolidGap, OutOfSolids) {
  const mesh::TriangleMesh cube = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const auto half = [](double from, double to) { return box(Vec3(from, -2, -2), Vec3(to, 2, 2)); };
  EXPECT_LE(outside(cube, {half(-2, 2)}).out_mm, 0);
  EXPECT_LE(outside(cube, {cube}).out_mm, 1e-12) << "the same surface";
  EXPECT_NEAR(outside(cube, {half(-2, 0.25)}).out_mm, 0.75, 1e-12);
  EXPECT_LE(outside(cube, {half(-2, 0), half(0, 2)}).out_mm, 1e-12) << "two halves";
  EXPECT_LE(outside(cube, {half(-2, 0.3), half(-0.3, 2)}).out_mm, 0) << "two that overlap";
  // A slit between two halves: every corner is in one of them.
  EXPECT_NEAR(outside(cube, {half(-2, -0.3), half(0.3, 2)}).out_mm, 0.3, 0.1);
  EXPECT_NEAR(outside(cube, {box(Vec3(5, -1, -1), Vec3(6, 1, 1))}).out_mm, 6, 1e-12) << "all of it";
}

}  // namespace
}  // namespace toothpath::test
