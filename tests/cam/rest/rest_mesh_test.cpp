// The mesh of what is left holds it: random balls are taken out of turned blanks, and no place that no ball reached is
// missing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cam/clearance/distance.h"
#include "cam/rest/rest_mesh.h"
#include "geometry/mesh/cgal_check.h"
#include "tests/support/random.h"

namespace toothpath::rest {
namespace {

constexpr int kTeeth = 24;
constexpr double kPitch = 2 * std::numbers::pi / kTeeth;

/// Two rings with a groove between them, its lands twisted; heights along z.
Blank blank(double twist) {
  Blank b;
  b.teeth = kTeeth;
  b.place = [](double r, double z, double azimuth) { return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z); };
  const auto begin = [twist](double r) { return -0.5 * kPitch + twist * (r - 40); };
  const auto top = [](double r) { return 2 + 0.1 * (r - 40); };  // a hollow cone
  b.rings = {{40, 46, top, begin, -3}, {48, 54, top, begin, -3}};
  b.corners = {{{46, -3.5}, {48, -3.5}}, {{54, -10}, {40, -10}}};
  return b;
}

struct Balls {
  std::vector<cut::BallMove> moves;
  double radius = 1.2;
  [[nodiscard]] double distance(const Vec3& p) const {
    double least = INFINITY;
    for (const auto& m : moves) least = std::min(least, distance_to_segment(p, m.from, m.to));
    return least - radius;
  }
};

Balls random_balls(test::Random& random) {
  Balls balls;
  for (int k = 0; k < 12; ++k) {
    const double angle = random(-0.3, 0.3) * kPitch, z = random(1.2, 2.4);
    const auto at = [&](double r) { return Vec3(r * std::cos(angle), r * std::sin(angle), z); };
    balls.moves.push_back({at(39), at(random(44, 55))});
  }
  return balls;
}

Excess excess_of_balls(const Balls& balls) {
  std::vector<std::unique_ptr<cut::Removed>> removed;
  removed.push_back(std::make_unique<cut::Removed>(balls.moves, balls.radius));
  return excess_of(std::move(removed));
}

void expect_solid(const mesh::TriangleMesh& mesh) {
  const auto check = mesh::check_mesh(mesh);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_TRUE(check->is_solid()) << check->self_intersections << " crossings";
  EXPECT_EQ(check->components, 1u);
}

TEST(RestMesh, TheBlankIsTheTurnedBody) {
  const auto mesh = rest_mesh(blank(0), {});
  ASSERT_TRUE(mesh);
  expect_solid(*mesh);
  // Rings by their sections: height over the underside times the circle of their middle, Pappus.
  const auto ring = [](double a, double b) {
    const double pi = std::numbers::pi;  // integral of (12 + 0.1 (r - 40)) 2 pi r
    const auto f = [&](double r) { return 2 * pi * (8 * r * r / 2 + 0.1 * r * r * r / 3); };
    return f(b) - f(a);
  };
  const double volume = ring(40, 46) + ring(48, 54) + std::numbers::pi * (48 * 48 - 46 * 46) * 6.5;
  EXPECT_NEAR(mesh::signed_volume(*mesh), volume, 2e-4 * volume);
}

TEST(RestMesh, LeavesOutNothingThatNoBallReached) {
  test::Random random(7);
  for (int trial = 0; trial < 6; ++trial) {
    const Balls balls = random_balls(random);
    const Blank b = blank(trial % 2 == 0 ? 0 : 0.01);
    RestOptions options;
    options.cell_mm = trial < 3 ? 0.3 : 0.8;
    const auto mesh = rest_mesh(b, excess_of_balls(balls), options);
    ASSERT_TRUE(mesh);
    expect_solid(*mesh);
    const clearance::MeshDistance solid(*mesh);
    int missing = 0, removed = 0;
    for (int k = 0; k < 4000; ++k) {
      const double r = random(0, 1) < 0.5 ? random(40.01, 45.99) : random(48.01, 53.99);
      const double angle = random(-0.5, 0.5) * kPitch, z = random(-3, b.rings[0].top(r) - 0.01);
      const Vec3 p = b.place(r, z, angle);
      const bool gone = balls.distance(p) < 0;
      removed += gone;
      if (solid.inside(p)) continue;
      ++missing;
      EXPECT_TRUE(gone) << trial << ": " << p.transpose() << " is " << balls.distance(p) << " mm from every ball";
    }
    EXPECT_GT(missing, removed / 5) << "what is gone is seen";
    EXPECT_LE(missing, removed);
  }
}

TEST(RestMesh, IsWiderByWhatMayBeWrong) {
  test::Random random(11);
  const Balls balls = random_balls(random);
  RestOptions options;
  const auto exact = rest_mesh(blank(0), excess_of_balls(balls), options);
  options.within_mm = 0.2;
  const auto careful = rest_mesh(blank(0), excess_of_balls(balls), options);
  ASSERT_TRUE(exact && careful);
  EXPECT_GT(mesh::signed_volume(*careful), mesh::signed_volume(*exact) + 1);
}

TEST(RestMesh, RefusesCellsOfNoSize) {
  RestOptions options;
  options.cell_mm = 0;
  const auto mesh = rest_mesh(blank(0), {}, options);
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.error().message.find("cell = 0"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::rest
