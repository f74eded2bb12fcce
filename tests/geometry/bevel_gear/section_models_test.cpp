// Section-sweep models against the envelope: the page's numbers, and the moving cutter as the judge.
#include "geometry/bevel_gear/section_models.h"

#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

/// The distance of a model's point from the solid mill over the whole pass knows neither the meshing equation nor the
/// inverse: what the mill takes away below the model's surface is the deviation. Measured along the shortest way, not
/// along equal cone distance and height.
TEST(SectionModels, DeviationIsWhatTheMovingCutterRemoves) {
  for (const auto& g : {made(w1(), pinion_mill()), made(w2(), wheel_mill())}) {
    const auto& half = g.halves()[0];
    const bevel_gear::FingerSolid solid(g.cutter());
    for (int k = 0; k < 2; ++k)
      for (const bevel_gear::SectionModel model :
           {bevel_gear::SectionModel::centre_path, bevel_gear::SectionModel::tooth_trace})
        for (const double beta_share : {0.1, 0.5, 0.9})
          for (const double p : {-8.0, 0.0, 6.0, 10.5}) {
            const auto& w = half.walls[k];
            const double beta = w.trace.beta(g.R_i() + beta_share * (g.R_e() - g.R_i()));
            const Vec3 q = bevel_gear::section_model_point(model, w, beta, p);
            const bevel_gear::ConePoint at = bevel_gear::cone_point(q, g.sin_delta(), g.cos_delta());
            const auto deviation = bevel_gear::section_model_deviation(model, w, at.ell, at.height);
            ASSERT_TRUE(deviation);
            // Both ways differ by half the curvature (0.04/mm) over the squared cosine of the way's lean: about 0.01/mm
            // times the square.
            EXPECT_NEAR(*deviation, clearance_of_pass(q, w.trace, w.sigma, half.beta_from[k], half.beta_to[k], solid),
                        1e-9 + 0.02 * *deviation * *deviation)
                << k << ' ' << beta_share << ' ' << p;
          }
  }
}

TEST(SectionModels, ThePagesNumbers) {
  struct Expected {
    double least, greatest, rms;
  };
  // Pinion L: S1, S2; U: S1, S2; then the wheel. The page prints -10.2 and -12.4 um for the pinion's wall L; at the
  // corner of the face (R_i, h_a) the moving cutter decides for -10.04 and -12.15 (test below).
  const Expected expected[2][4] = {{{-10.04, 0, 2.5}, {-12.15, 0.4, 3.1}, {-9.1, 0, 2.3}, {-19.2, 0.2, 5.2}},
                                   {{-0.43, 0, 0.11}, {-1.7, 0.3, 0.5}, {-0.47, 0, 0.11}, {-0.8, 0.3, 0.3}}};
  for (int gear = 0; gear < 2; ++gear) {
    const bevel_gear::BevelGear g = gear == 0 ? made(w1(), pinion_mill()) : made(w2(), wheel_mill());
    const auto maps = bevel_gear::section_model_maps(g, {25, 41, -3.2, 4.1});
    ASSERT_EQ(maps.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& e = expected[gear][i];
      EXPECT_NEAR(1000 * maps[i].least_mm, e.least, 0.06) << gear << ' ' << i;
      EXPECT_NEAR(1000 * maps[i].greatest_mm, e.greatest, 0.06) << gear << ' ' << i;
      EXPECT_NEAR(1000 * maps[i].rms_mm, e.rms, 0.06) << gear << ' ' << i;
      for (const double d : maps[i].deviation_mm) EXPECT_TRUE(std::isfinite(d));
    }
  }
}

TEST(SectionModels, WorstCornerOfThePinionByTheMovingCutter) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const auto& half = g.halves()[0];
  const auto& w = half.walls[0];
  const bevel_gear::FingerSolid solid(g.cutter());
  const double expected[2] = {-10.04, -12.15};
  for (const bevel_gear::SectionModel model :
       {bevel_gear::SectionModel::centre_path, bevel_gear::SectionModel::tooth_trace}) {
    // The model's point at (R_i, h_a), by bisection of nothing but its own points: p from the height, beta from the
    // cone distance.
    double beta = w.trace.beta(g.R_i()), p = 11;
    for (int k = 0; k < 60; ++k) {
      const bevel_gear::ConePoint at =
          bevel_gear::cone_point(bevel_gear::section_model_point(model, w, beta, p), g.sin_delta(), g.cos_delta());
      p += (4.1 - at.height) / 0.35;
      beta -= (g.R_i() - at.ell) / (2 * g.R_0() * std::sin(beta) * std::cos(beta));
    }
    const bevel_gear::ConePoint at =
        bevel_gear::cone_point(bevel_gear::section_model_point(model, w, beta, p), g.sin_delta(), g.cos_delta());
    ASSERT_NEAR(at.ell, g.R_i(), 1e-9);
    ASSERT_NEAR(at.height, 4.1, 1e-9);
    const double brute = clearance_of_pass(bevel_gear::section_model_point(model, w, beta, p), w.trace, 1,
                                           half.beta_from[0], half.beta_to[0], solid);
    EXPECT_NEAR(1000 * brute, expected[model == bevel_gear::SectionModel::centre_path ? 0 : 1], 0.01);
  }
}

TEST(SectionModels, EstimateGrowthAndVanishing) {
  // Within 5 % where it matters.
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  for (const auto& w : g.halves()[0].walls) {
    const auto at = bevel_gear::bevel_inverse(w, g.R_i(), 4.0);
    EXPECT_NEAR(bevel_gear::centre_path_estimate(w, at->beta, at->p) /
                    *bevel_gear::section_model_deviation(bevel_gear::SectionModel::centre_path, w, g.R_i(), 4.0),
                1, 0.05);
  }
  // Crown wheel: nothing to see.
  for (const auto& m : bevel_gear::section_model_maps(gear_of(design(30, 0, 4, 35, 0.25, 1, 90)), {7, 7, 0, 0}))
    if (m.model == bevel_gear::SectionModel::centre_path) { EXPECT_LT(std::max(-m.least_mm, m.greatest_mm), 1e-9); }
  // Few teeth, small pitch angle: tens of micrometres; 45 deg spiral: some.
  const auto worst = [](const bevel_gear::BevelGear& gear) {
    double least = 0;
    for (const auto& m : bevel_gear::section_model_maps(gear, {7, 9, 0, 0}))
      if (m.model == bevel_gear::SectionModel::centre_path) least = std::min(least, m.least_mm);
    return 1000 * least;
  };
  const double few = worst(gear_of(design(7, 40, 4, 30, 0.2))), steep = worst(gear_of(design(12, 60, 3, 45, 0.25)));
  EXPECT_LT(few, -35);
  EXPECT_GT(few, -120);
  EXPECT_LT(steep, -3);
  EXPECT_GT(steep, -20);
}

}  // namespace
}  // namespace toothpath
