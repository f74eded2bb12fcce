// Facets on a grid of whole numbers that meet in a place which is exact in double: none of them may be said apart.
#include "geometry/mesh/facets_apart.h"

#include <gtest/gtest.h>

#include "tests/geometry/mesh/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using Facet = std::array<std::size_t, 3>;

class FacetsApart : public testing::Test {
 protected:
  double whole(double from, double to) { return std::floor(random_(from, to)); }
  /// Flat ones among them: in a plane across the last axis, or steeper.
  Vec3 corner(double size) {
    const double x = 64 * whole(-size, size), y = 64 * whole(-size, size);
    return {x, y, flat_ ? 64 * slope_ * (x + y) : 64 * whole(-size, size)};
  }
  /// A place of the facet other than its first corner.
  Vec3 place(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double i = whole(1, 65), k = whole(0, i + 1);
    return a + (i - k) / 64 * (b - a) + k / 64 * (c - a);
  }
  void next(int n) {
    flat_ = n % 3 == 0;
    slope_ = n % 2;
  }
  Random random_{97};
  bool flat_ = false;
  double slope_ = 0;
};

TEST_F(FacetsApart, AreNeverThoseThatMeet) {
  for (int n = 0; n < 6000; ++n) {
    next(n);
    const double size = n % 5 == 0 ? 3 : 1 << 20;
    const Vec3 a = corner(size), b = corner(size), c = corner(size), p = place(a, b, c), q = corner(size);
    // The place halves an edge of the other one.
    EXPECT_FALSE(mesh::surely_apart({a, b, c, q, 2 * p - q, corner(size)}, {0, 1, 2}, {3, 4, 5})) << n;
    // From a common corner the edge goes on beyond the place; three such corners in turn.
    const Facet turned{std::size_t(n % 3), std::size_t((n + 1) % 3), std::size_t((n + 2) % 3)};
    EXPECT_FALSE(mesh::surely_apart({a, b, c, 2 * p - a, q}, turned, {0, 3, 4})) << n;
    // On the same side of a common edge, in one plane.
    const double along = whole(-9, 9), up = whole(1, 9);
    EXPECT_FALSE(mesh::surely_apart({a, b, c, a + along * (b - a) + up * (c - a)}, turned, {1, 0, 3})) << n;
    EXPECT_FALSE(mesh::surely_apart({a, b, c}, turned, {1, 0, 2})) << n;
  }
}

TEST_F(FacetsApart, AreNearlyAllNeighboursOfASoundMesh) {
  const mesh::TriangleMesh gear = mesh::join_copies(meshed(made(spur_parameters()), 1.0));
  std::vector<std::vector<std::size_t>> at(gear.vertices.size());
  std::vector<Facet> facets;
  for (const auto& t : gear.triangles) {
    for (const auto corner : t) at[std::size_t(corner)].push_back(facets.size());
    facets.push_back({std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])});
  }
  std::size_t pairs = 0, told = 0;
  for (const auto& fan : at)
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (std::size_t k = 0; k < i; ++k, ++pairs)
        told += mesh::surely_apart(gear.vertices, facets[fan[i]], facets[fan[k]]);
  EXPECT_GT(pairs, 10000u);
  EXPECT_GT(double(told), 0.98 * double(pairs)) << told << " of " << pairs;
}

}  // namespace
}  // namespace toothpath::test
