// The bricks of bevel teeth stand on the exact walls; the cells know where they are and how they near.
#include "geometry/loaded_bevel/bevel_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/loaded_bevel/bevel_flanks.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

using bevel_gear::BevelGear;

TEST(BevelBody, StandsOnTheWalls) {
  const auto plan = coarse_bodies().wheel.bricks;
  for (const BevelGear* gear : {&herringbone_gears().first, &herringbone_gears().second})
    for (const int half : {0, 1})
      for (const int sigma : {1, -1}) {
        const auto body = loaded_bevel::bevel_bricks(*gear, half, sigma, plan);
        ASSERT_TRUE(body) << body.error().message;
        const auto& own = gear->halves()[static_cast<std::size_t>(half)];
        const elastic::Sector& s = body->sector;
        EXPECT_GT(s.least_jacobian, 0);
        EXPECT_EQ(s.faces.size(), static_cast<std::size_t>(plan.flank * plan.face));
        const double d = gear->sin_delta(), c = gear->cos_delta();
        for (const auto& face : s.faces)
          for (const int node : face.nodes) {
            const auto at = bevel_gear::cone_point(s.nodes[static_cast<std::size_t>(node)], d, c);
            const auto wall = bevel_gear::bevel_inverse(own.wall(sigma), at.ell, at.height);
            ASSERT_TRUE(wall);
            // Wall L of space 0, wall U of space -1.
            const double azimuth = wall->azimuth - (sigma < 0 ? gear->pitch() : 0);
            EXPECT_LT(std::abs(wrapped(at.azimuth - azimuth)) * at.ell, 1e-7);
          }
        for (std::size_t k = 0; k < s.stations.size(); ++k) {
          const Vec3& p = s.nodes[static_cast<std::size_t>(s.stations[k])];
          const auto at = bevel_gear::cone_point(p, d, c);
          const auto wall = bevel_gear::bevel_inverse(own.wall(sigma), at.ell, at.height);
          const Vec3 normal = turned(own.wall(sigma).point(wall->beta, wall->p).n, sigma < 0 ? -gear->pitch() : 0);
          EXPECT_GT(normal.dot(s.normals[k]), 0.995) << "out of the tooth";
        }
        for (const int node : s.held)
          EXPECT_NEAR(bevel_gear::cone_point(s.nodes[static_cast<std::size_t>(node)], d, c).height,
                      -gear->parameters().dedendum_mm - plan.rim_mm, 1e-9);
        for (std::size_t k = 0; k < s.low_cut.size(); ++k)
          EXPECT_LT((s.pitch * s.nodes[static_cast<std::size_t>(s.low_cut[k])] -
                     s.nodes[static_cast<std::size_t>(s.high_cut[k])])
                        .norm(),
                    1e-9);
      }
}

TEST(BevelBody, NeighboursFeelEachOtherAlike) {
  const auto body = loaded_bevel::bevel_body(single_gears().second, 0, 1, coarse_bodies().wheel);
  ASSERT_TRUE(body) << body.error().message;
  ASSERT_EQ(body->reach, 1);
  const auto &before = body->remainder[0], &after = body->remainder[2];
  EXPECT_LT((before - after.transpose()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(after.minCoeff(), -0.1 * after.cwiseAbs().maxCoeff());
  const auto plan = coarse_bodies().wheel;
  const auto C = elastic::tooth_compliance(body->sector, plan.nu, plan.teeth);
  ASSERT_TRUE(C);
  for (Eigen::Index k = 0; k < C->at_offset[1].rows(); ++k) {
    EXPECT_GT(C->at_offset[1](k, k), 0);
    EXPECT_GT(C->at_offset[1](k, k), 3 * std::abs(C->at_offset[0](k, k)));
  }
  EXPECT_LT((C->at_offset[0] - C->at_offset[2].transpose()).cwiseAbs().maxCoeff(),
            0.04 * C->at_offset[1].cwiseAbs().maxCoeff());
}

TEST(BevelBody, EndsMirror) {
  const auto body = loaded_bevel::bevel_bricks(single_gears().first, 0, 1, coarse_bodies().pinion.bricks);
  ASSERT_TRUE(body);
  const BevelGear& gear = single_gears().first;
  const auto& ends = body->ends;
  const Vec3 p = bevel_gear::blank_point(95, 1.5, 0.7, gear.sin_delta(), gear.cos_delta());
  for (const std::size_t end : {0u, 1u}) {
    const Vec3 image = ends.mirrored(p, end);
    const auto at = bevel_gear::cone_point(image, gear.sin_delta(), gear.cos_delta());
    EXPECT_NEAR(at.ell, 2 * ends.at[end] - 95, 1e-10);
    EXPECT_NEAR(at.height, 1.5, 1e-10);
    EXPECT_NEAR(at.azimuth, 0.7, 1e-12);
    EXPECT_LT((ends.mirrored(image, end) - p).norm(), 1e-10);
  }
}

TEST(BevelBody, RefusesARimThatReachesTheAxis) {
  auto plan = coarse_bodies().pinion.bricks;
  const BevelGear& gear = single_gears().first;
  plan.rim_mm = loaded_bevel::thickest_rim(gear);
  EXPECT_TRUE(loaded_bevel::bevel_bricks(gear, 0, 1, plan));
  for (const double rim : {1.001 * plan.rim_mm, 0.0, -1.0, std::nan("")}) {
    plan.rim_mm = rim;
    const auto body = loaded_bevel::bevel_bricks(gear, 0, 1, plan);
    ASSERT_FALSE(body) << rim;
    EXPECT_NE(body.error().message.find("is not between 0 and"), std::string::npos) << body.error().message;
  }
}

TEST(BevelFlanks, KnowTheirPlacesAndLevers) {
  for (const int sigma : {1, -1}) {
    auto options = coarse_bodies();
    options.moved = {2e-4, 0.02, 0.03, -0.01};
    const auto pair = single_pair(sigma, options);
    const double phi = 0.4 * pair.pair.pinion().pitch(), phi_2 = -phi / pair.pair.ratio();
    const loaded_bevel::BevelFlanks flanks(pair, phi);
    ASSERT_GE(flanks.sites().size(), 1u);
    constexpr double kNear = 0.01;  // mm
    double first = 1e300;
    int near = 0;
    for (const auto& site : flanks.sites()) {
      constexpr int kColumns = 60, kRows = 90;
      const auto places = flanks.places(site, kColumns, kRows);
      ASSERT_EQ(places.size(), static_cast<std::size_t>(kColumns * kRows));
      const double turn_2 = phi_2 + site.tooth * pair.pair.wheel().pitch();
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (!places[k].material) continue;
        const loaded::Segment& s = places[k].at;
        const Vec3 off = s.point - site.point;
        EXPECT_NEAR(off.dot(site.across),
                    site.x - site.half_x + (double(k % kColumns) + 0.5) * 2 * site.half_x / kColumns, 1e-7);
        EXPECT_NEAR(off.dot(site.along), site.y - site.half_y + (double(k / kColumns) + 0.5) * 2 * site.half_y / kRows,
                    1e-7);
        const auto on_wheel = pair.pair.wheel_place(0, sigma, s.r, s.z);
        ASSERT_TRUE(on_wheel);
        EXPECT_LT((pair.pair.to_pinion(on_wheel->point, turn_2) - s.point).norm(), 1e-7);
        first = std::min(first, s.gap);
        if (s.gap > kNear) continue;
        ++near;
        // Where flanks nearly touch, the wheel, turned a little, nears the standing pinion by its lever.
        const auto gap = [&](double d) {
          bevel_gear::BevelInverse start;
          const auto turn = pair.pair.turn_at(0, sigma, on_wheel->point, turn_2 + d, start);
          return turn ? sigma * *turn * pair.pair.lever(*on_wheel, turn_2) : std::nan("");
        };
        const double rate = (gap(1e-5) - gap(-1e-5)) / 2e-5;
        if (!std::isnan(rate)) {
          EXPECT_NEAR(std::abs(rate), places[k].lever * pair.lever, 0.05 * pair.lever);
          EXPECT_LT(rate * sigma, 0) << "the wheel turns against the pinion";
        }
      }
    }
    // The rigid pinion stops at the first place: nothing overlaps, and something is near.
    EXPECT_GT(first, -2e-3);
    EXPECT_LT(first, kNear);
    EXPECT_GT(near, 5);
  }
}

}  // namespace
}  // namespace toothpath::test
