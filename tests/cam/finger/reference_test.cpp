// The room of a centre before the cutter touches a wall, against brute force: distances of the solid cutter from a
// dense patch of the wall.
#include <algorithm>
#include <random>

#include "cam/finger/passes.h"
#include "cam/finger/reference.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

struct Case {
  const char* name;
  Designed gear;
  double mill_share;  ///< of the largest module that the space at the small end takes; 0: the mill of the design
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

bevel_gear::BevelGear gear_of_case(const Case& c) {
  bevel_gear::FingerCutterData mill = c.gear.c;
  if (c.mill_share > 0) mill.module_mm = c.mill_share * made(c.gear.p, mill).limits().module_limit_mm;
  return made(c.gear.p, mill);
}

class SmallEnd : public ::testing::TestWithParam<Case> {};

// Within its reach before and behind the small end, on the path and up to 0.6 mm beyond: nowhere deeper than told.
// Where the pass has run out of the face only the edge of the wall counts, which is less than the distance from the
// path.
TEST_P(SmallEnd, RoomIsNeverTooGood) {
  const bevel_gear::BevelGear g = gear_of_case(GetParam());
  const bevel_gear::FingerSolid solid(g.cutter());
  const double reach = g.cutter().rho_D, h_a = g.parameters().addendum_mm, h_f = g.parameters().dedendum_mm;
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967295.0; };
  for (const int sigma : {1, -1}) {
    const auto& wall = g.halves()[0].wall(sigma);
    const finger::WallReference reference(g, sigma);
    std::vector<Vec3> patch;
    const double length = std::min(2.5 * reach, g.halves()[0].ell_to - g.R_i());
    for (int i = 0; i <= 48; ++i)
      for (int j = 0; j <= 80; ++j) {
        const double ell = g.R_i() + length * i * i / (48.0 * 48.0), height = -0.99 * h_f + (h_a + 0.99 * h_f) * j / 80;
        if (const auto at = bevel_gear::bevel_inverse(wall, ell, height))
          patch.push_back(bevel_gear::blank_point(ell, height, at->azimuth, g.sin_delta(), g.cos_delta()));
      }
    ASSERT_GT(patch.size(), 2000u);
    int beyond = 0;
    double tightest = 1e9;
    for (int n = 0; n < 400; ++n) {
      const double R_c = g.R_i() - uniform(-0.3, 1.3) * reach;
      const double path = reference.theta_at(R_c) - sigma * uniform(0, std::min(0.6, 0.3 * reach)) / R_c;
      const double side = reference.side(R_c, path);
      beyond += reference.offset(R_c, path) < 0 && side > reference.offset(R_c, path);
      double least = 1e9;
      for (const Vec3& p : patch)
        least = std::min(least, solid.signed_distance(bevel_gear::cutter_from_blank<double>(
                                    p, R_c, path / g.sin_delta(), g.sin_delta(), g.cos_delta())));
      const double bound = side < 0     ? side * reference.leverage()
                           : side > 1e8 ? 0
                                        : side;  // no tooth in reach: more than nothing
      tightest = std::min(tightest, least - bound);
      EXPECT_GE(least, bound - 1e-9) << "sigma " << sigma << " R_c " << R_c << " side " << side << " R_i " << g.R_i()
                                     << " engaged from " << reference.engaged_from();
    }
    EXPECT_GT(beyond, 20) << "the edge decides";
    EXPECT_LT(tightest, 0.05 * reach) << "the bound is near the truth somewhere";
  }
}

// The least R_c with a contact on the face, by the contacts themselves.
TEST_P(SmallEnd, EngagementBeginsWhereAContactReachesTheFace) {
  const bevel_gear::BevelGear g = gear_of_case(GetParam());
  for (const int sigma : {1, -1}) {
    const auto& half = g.halves()[0];
    const auto& wall = half.wall(sigma);
    const finger::WallReference reference(g, sigma);
    const int k = sigma > 0 ? 0 : 1;
    double first = 1e9;
    for (int i = 0; i <= 1000; ++i) {
      const double beta = half.beta_from[k] + (half.beta_to[k] - half.beta_from[k]) * i / 1000;
      for (int j = 0; j <= 400; ++j) {
        const auto at = wall.generatrix(beta, wall.cutter.p_A + (wall.cutter.p_D - wall.cutter.p_A) * j / 400);
        if (at[1] <= g.parameters().addendum_mm && at[0] >= g.R_i())
          first = std::min(first, wall.trace.centre(sigma, beta).R_c);
      }
    }
    EXPECT_LE(reference.engaged_from(), first + 1e-9) << "sigma " << sigma;
    EXPECT_GE(reference.engaged_from(),
              first - 0.1 * g.cutter().rho_D - (reference.R_c_to(0) - reference.R_c_from(0)) / 100)
        << "sigma " << sigma;
  }
}

// Places of the whole path, corner and straight run-out with it: at distance zero from it, along its own heading, in
// one run.
TEST_P(SmallEnd, PlacesLieOnThePath) {
  const bevel_gear::BevelGear g = gear_of_case(GetParam());
  const double from = g.R_i() - 0.1 * g.cutter().rho_D, to = g.R_e() + 1.2 * g.cutter().rho_D,
               step = (to - from) / 4000;
  for (const int sigma : {1, -1}) {
    const finger::WallReference wall(g, sigma);
    const auto joints = wall.joints();
    EXPECT_TRUE(std::is_sorted(joints.begin(), joints.end()));
    auto before = wall.place_at(from);
    for (int k = 1; k <= 4000; ++k) {
      const auto c = wall.place_at(from + step * k);
      EXPECT_NEAR(wall.offset(c.R_c, c.theta_c), 0, 1e-9) << "R_c " << c.R_c;
      EXPECT_NEAR(c.e * g.sin_delta(), c.theta_c, 1e-12);
      // The chord of a step has the heading of its middle, but for the third order; not across the corner of the
      // concave side.
      const bool corner =
          std::any_of(joints.begin(), joints.end(), [&](double R) { return R >= before.R_c && R <= c.R_c; });
      if (!corner) {
        const double slope = (c.theta_c - before.theta_c) / step;
        EXPECT_NEAR(slope, 0.5 * (std::tan(c.beta_c) / c.R_c + std::tan(before.beta_c) / before.R_c), 1e-3 / g.R_i())
            << "R_c " << c.R_c;
      }
      EXPECT_LT(finger::crown_distance(before, c), 3 * step) << "R_c " << c.R_c;
      before = c;
    }
  }
}

// The space of a gear with few teeth closes quickly before its small end, and both walls bend. Every roughing pass
// keeps to the space side of both wall paths all along, from before the small end until the cutter is clear of the
// large end.
TEST_P(SmallEnd, RoughingPassesStayBetweenTheWalls) {
  const bevel_gear::BevelGear g = gear_of_case(GetParam());
  const finger::WallReference L(g, 1), U(g, -1);
  for (const double share : {0.2, 0.004}) {
    double ridge = 0;
    std::size_t fills = 0;
    double first = 1e9, last = 0;
    for (const auto& pass : finger::roughing_passes(g, share * g.parameters().dedendum_mm, ridge)) {
      fills += pass.name != "middle";
      for (const auto& piece : pass.pieces)
        for (int k = 0; k <= 200; ++k) {
          const auto c = piece.at(k / 200.0);
          first = std::min(first, c.R_c), last = std::max(last, c.R_c);
          EXPECT_GE(std::min(L.offset(c.R_c, c.theta_c), U.offset(c.R_c, c.theta_c)), -1e-9)
              << pass.name << " R_c " << c.R_c;
        }
    }
    EXPECT_LT(first, g.R_i()) << "the whole face";
    EXPECT_GT(last, g.R_e() + g.cutter().rho_D);
    if (share < 0.01) { EXPECT_GT(fills, 1u); }
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, SmallEnd,
                         ::testing::Values(Case{"w3", {w3(), pinion_mill()}, 0},
                                           Case{"seven_teeth", design(7, 0, 2.0, 30, 0.32, 1, 30), 0.99},
                                           Case{"flat_cone", design(7, 0, 10.0, 30, 0.27, -1, 75.2), 0.96},
                                           Case{"slender", design(9, 0, 6.0, 5, 0.25, 1, 20), 0.97}),
                         [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace toothpath
