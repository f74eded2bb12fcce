// The mesh of what is left holds it: random balls are taken out of turned blanks, and no place that no ball reached is
// missing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cam/clearance/distance.h"
#include "cam/cut/swept_tool.h"
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

/// Slots that are open upwards: layers of balls along the top, from above it down.
Balls slots(test::Random& random, double twist) {
  Balls balls;
  for (int k = 0; k < 6; ++k) {
    const double angle = random(-0.3, 0.3) * kPitch, deepest = random(0, 2.5);
    for (double depth = -0.3; depth < deepest; depth += 0.2) {
      const auto at = [&](double r, double a) {
        const double turned = a + twist * (r - 40);
        return Vec3(r * std::cos(turned), r * std::sin(turned), 2 + 0.1 * (r - 40) - depth);
      };
      for (int i = 0; i < 8; ++i) balls.moves.push_back({at(38 + 2.25 * i, angle), at(40.25 + 2.25 * i, angle)});
    }
  }
  return balls;
}

Excess excess_of_balls(const Balls& balls) {
  std::vector<Excess> removed;
  const auto one = std::make_shared<const cut::Removed>(balls.moves, balls.radius);
  removed.emplace_back([one](const Vec3& p, double cap) { return one->excess(p, cap); });
  return excess_of(std::move(removed));
}

void expect_solid(const mesh::TriangleMesh& mesh) {
  const auto check = mesh::check_mesh(mesh);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_TRUE(check->is_solid()) << check->self_intersections << " crossings";
  EXPECT_EQ(check->components, 1u);
}

TEST(RestMesh, TheBlankIsTheTurnedBody) {
  const auto rest = rest_mesh(blank(0), {});
  ASSERT_TRUE(rest);
  expect_solid(rest->mesh);
  // Rings by their sections: height over the underside times the circle of their middle, Pappus.
  const auto ring = [](double a, double b) {
    const double pi = std::numbers::pi;  // integral of (12 + 0.1 (r - 40)) 2 pi r
    const auto f = [&](double r) { return 2 * pi * (8 * r * r / 2 + 0.1 * r * r * r / 3); };
    return f(b) - f(a);
  };
  const double volume = ring(40, 46) + ring(48, 54) + std::numbers::pi * (48 * 48 - 46 * 46) * 6.5;
  EXPECT_NEAR(mesh::signed_volume(rest->mesh), volume, 2e-4 * volume);
}

/// What random places of the teeth say of a mesh.
struct Asked {
  int removed = 0, missing = 0, wrong = 0;
  double thick = 0;  ///< deepest inside of what the balls took, of places that the mesh has
};
Asked ask(const Blank& b, const Balls& balls, const mesh::TriangleMesh& mesh, test::Random& random, int places) {
  const clearance::MeshDistance solid(mesh);
  Asked asked;
  for (int k = 0; k < places; ++k) {
    const double r = random(0, 1) < 0.5 ? random(40.01, 45.99) : random(48.01, 53.99);
    const double azimuth = b.rings[0].begin(r) + random(0.01, 0.99) * kPitch;
    const Vec3 p = b.place(r, random(-3, b.rings[0].top(r) - 0.01), azimuth);
    const double distance = balls.distance(p);
    asked.removed += distance < 0;
    if (solid.inside(p)) {
      asked.thick = std::max(asked.thick, -distance);
      continue;
    }
    ++asked.missing;
    asked.wrong += distance >= 0;
  }
  return asked;
}

TEST(RestMesh, LeavesOutNothingThatNoBallReached) {
  test::Random random(7);
  for (int trial = 0; trial < 4; ++trial) {
    const Balls balls = random_balls(random);
    const Blank b = blank(trial % 2 == 0 ? 0 : 0.01);
    RestOptions options;
    options.cell_mm = trial < 2 ? 0.6 : 0.9;
    const auto rest = rest_mesh(b, excess_of_balls(balls), options);
    ASSERT_TRUE(rest);
    if (trial == 1) expect_solid(rest->mesh);
    const Asked asked = ask(b, balls, rest->mesh, random, 4000);
    EXPECT_EQ(asked.wrong, 0) << "missing, but no ball was there";
    EXPECT_GT(asked.missing, asked.removed / 5) << "what is gone is seen";
    EXPECT_LE(asked.thick, rest->thick_mm) << "below overhangs, too";
  }
}

/// Where nothing hangs over, what stands too thick is a part of a cell.
TEST(RestMesh, StandsNoThickerThanItSays) {
  test::Random random(19);
  for (int trial = 0; trial < 4; ++trial) {
    const double twist = trial % 2 == 0 ? 0 : 0.01;
    const Balls balls = slots(random, twist);
    const Blank b = blank(twist);
    RestOptions options;
    options.cell_mm = trial < 2 ? 0.6 : 0.8;
    const auto rest = rest_mesh(b, excess_of_balls(balls), options);
    ASSERT_TRUE(rest);
    if (trial == 1) expect_solid(rest->mesh);
    const Asked asked = ask(b, balls, rest->mesh, random, 8000);
    EXPECT_EQ(asked.wrong, 0) << "missing, but no ball was there";
    EXPECT_GT(asked.missing, asked.removed * 2 / 3);
    EXPECT_LE(asked.thick, rest->thick_mm);
    EXPECT_GT(asked.thick, 0.3 * rest->thick_mm) << "the bound is of use";
    EXPECT_LT(rest->thick_mm, rest->cell_mm);
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
  EXPECT_GT(mesh::signed_volume(careful->mesh), mesh::signed_volume(exact->mesh) + 1);
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
