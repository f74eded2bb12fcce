// Distances of convex pieces and of solids made of them, against closed forms and against many points.
#include "postproc/bodies/convex.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/base/angle.h"
#include "postproc/bodies/solid.h"
#include "tests/machines/chains.h"

namespace toothpath::bodies {
namespace {

class Random {
 public:
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(rng_); }
  Vec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  Vec3 axis() { return test::random_axis(rng_); }
  machines::Place place(double size) {
    return {Eigen::AngleAxisd(number(-3, 3), axis()).toRotationMatrix(), vector(size)};
  }
  Convex piece() {
    switch (int(number(0, 3))) {
      case 0: return Box{vector(20), Vec3(number(0.1, 20), number(0.1, 20), number(0.1, 20))};
      case 1: return Cone{vector(20), axis(), number(0.1, 40), number(0, 20), number(0.1, 20)};
      default: return Triangle{{vector(20), vector(20), vector(20)}};
    }
  }
  /// A point of a piece.
  Vec3 point(const Convex& piece) {
    if (const auto* b = std::get_if<Box>(&piece))
      return b->centre + Vec3(number(-1, 1), number(-1, 1), number(-1, 1)).cwiseProduct(b->half);
    if (const auto* c = std::get_if<Cone>(&piece)) {
      const double t = number(0, 1), turn = number(-kPi, kPi);
      const double r = ((1 - t) * c->radius_from + t * c->radius_to) * std::sqrt(number(0, 1));
      const Vec3 e = c->axis.unitOrthogonal(), f = c->axis.cross(e);
      return c->from + t * c->length * c->axis + r * (std::cos(turn) * e + std::sin(turn) * f);
    }
    const auto& t = std::get<Triangle>(piece).corner;
    double u = number(0, 1), v = number(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
  }

 private:
  std::mt19937_64 rng_{7};
};

/// The true distance by descent between convex sets, slow: alternating over fine samples of points near the best.
TEST(Convex, BoundsHoldForManyPoints) {
  Random random;
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    const Convex a = random.piece(), b = random.piece();
    const machines::Place place = random.place(60);
    const Gap found = gap(a, b, place, 1e9);
    ASSERT_LE(found.proven, found.measured);
    ASSERT_LE(found.measured - found.proven, 1e-5) << i;
    apart += found.proven > 0 ? 1 : 0;
    for (int k = 0; k < 200; ++k)
      ASSERT_GE((random.point(a) - place.of(random.point(b))).norm(), found.proven - 1e-9) << i;
    const Gap back = gap(b, a, {place.turn.transpose(), -(place.turn.transpose() * place.shift)}, 1e9);
    EXPECT_NEAR(back.proven, found.proven, 2e-5) << i;
  }
  EXPECT_GT(apart, 1500);
  EXPECT_LT(apart, 2990);
}

TEST(Convex, ClosedForms) {
  const Convex box = Box{Vec3(0, 0, 0), Vec3(1, 2, 3)};
  EXPECT_NEAR(gap(box, Box{Vec3(0, 0, 0), Vec3(1, 1, 1)}, {Mat3::Identity(), Vec3(5, 0, 0)}, 100).proven, 3, 1e-6);
  EXPECT_NEAR(gap(box, Box{Vec3(0, 0, 0), Vec3(1, 1, 1)}, {Mat3::Identity(), Vec3(5, 7, 0)}, 100).proven, 5, 1e-6);
  const Convex rod = Cone{Vec3(10, 0, -50), Vec3::UnitZ(), 100, 2, 2};
  EXPECT_NEAR(gap(box, rod, {}, 100).proven, 7, 1e-6);
  const Convex tip = Cone{Vec3(0, 0, 10), Vec3::UnitZ(), 20, 0, 8};
  EXPECT_NEAR(gap(box, tip, {}, 100).proven, 7, 1e-6);
  // Overlapping, and one within the other.
  EXPECT_EQ(gap(box, Box{Vec3(1.5, 0, 0), Vec3(1, 1, 1)}, {}, 100).measured, 0);
  EXPECT_EQ(gap(box, Box{Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1)}, {}, 100).measured, 0);
  EXPECT_EQ(gap(rod, Box{Vec3(10, 0, 0), Vec3(0.1, 0.1, 0.1)}, {}, 100).measured, 0);
}

/// A cube of 12 triangles.
mesh::TriangleMesh cube(double half) {
  mesh::TriangleMesh m;
  for (int k = 0; k < 8; ++k) m.vertices.push_back(half * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

TEST(Solid, MeshesAreSolidAndBoxesAgree) {
  Random random;
  const Solid mesh(cube(10));
  const Solid box(std::vector<Convex>{Box{Vec3::Zero(), Vec3::Constant(10)}});
  const Solid rod(std::vector<Convex>{Cone{Vec3(0, 0, 0), Vec3::UnitZ(), 30, 4, 4},
                                      Cone{Vec3(0, 0, 30), Vec3::UnitZ(), 10, 4, 12}});
  for (int i = 0; i < 500; ++i) {
    const machines::Place place = random.place(45);
    const Gap a = mesh.gap_to(rod, place, 1e9), b = box.gap_to(rod, place, 1e9);
    EXPECT_NEAR(a.proven, b.proven, 1e-5) << i;
    const Gap c = rod.gap_to(mesh, {place.turn.transpose(), -(place.turn.transpose() * place.shift)}, 1e9);
    EXPECT_NEAR(a.proven, c.proven, 1e-5) << i;
    const Gap near = mesh.gap_to(rod, place, 5);
    if (a.proven > 5 + 1e-5) {
      EXPECT_EQ(near.proven, 5);
      EXPECT_TRUE(std::isinf(near.measured));
    } else {
      EXPECT_NEAR(near.proven, a.proven, 1e-5);
    }
  }
  // Wholly inside a mesh no facet is near.
  const Solid crumb(std::vector<Convex>{Box{Vec3::Zero(), Vec3::Constant(0.1)}});
  EXPECT_EQ(mesh.gap_to(crumb, {Mat3::Identity(), Vec3(1, 2, 3)}, 1e9).measured, 0);
  EXPECT_EQ(crumb.gap_to(mesh, {Mat3::Identity(), Vec3(1, 2, 3)}, 1e9).measured, 0);
  EXPECT_NEAR(mesh.gap_to(crumb, {Mat3::Identity(), Vec3(0, 0, 13)}, 1e9).proven, 2.9, 1e-6);
}

TEST(Solid, OverlapTellsTheWayOut) {
  const Solid box(std::vector<Convex>{Box{Vec3::Zero(), Vec3(10, 20, 30)}});
  const Solid rod(std::vector<Convex>{Cone{Vec3(0, 0, 0), Vec3::UnitZ(), 50, 5, 5}});
  const Overlap found = overlap(box, rod, {Mat3::Identity(), Vec3(12, 3, -10)});
  EXPECT_NEAR(found.depth_mm, 3, 1e-3);
  EXPECT_GT(found.direction.x(), 0.999);
}

}  // namespace
}  // namespace toothpath::bodies
