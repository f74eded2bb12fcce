// The rest of the two printed tables: the offset sample with every sign of its offset, and the columns of the extreme
// cases beside their limits.
#include <gtest/gtest.h>

#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

/// B at which the papers' parametrisation folds: cos^2 B (1 - kappa dZ/dB) = 0 as a polynomial in x = sin B; none
/// without a helix.
std::optional<double> fold_deg(const face_gear::FaceGearSurface<double>& f) {
  const double kappa = f.shaper.kappa, T = f.shaper.T, D = f.shaper.r_b * (1 / f.i + f.Cg);
  if (kappa == 0) return {};
  const auto F = [&](double x) {
    return f.Sg * (1 - x * x) - kappa * ((D - f.Sg * T * f.E) * x - (f.Sg * T * f.shaper.r_b - f.E * f.Cg));
  };
  double lo = kappa > 0 ? 0 : -1, hi = kappa > 0 ? 1 : 0;
  if ((F(lo) > 0) == (F(hi) > 0)) return {};
  for (int k = 0; k < 100; ++k) ((F(0.5 * (lo + hi)) > 0) == (F(lo) > 0) ? lo : hi) = 0.5 * (lo + hi);
  return degrees(std::asin(lo));
}

TEST(FaceGearTable, FoldsOfEveryHelicalRow) {
  const std::vector<std::pair<const char*, double>> rows = {
      {"beta_45", 21.82},          {"many_teeth", 14.92},     {"module_30", 39.22},
      {"alpha_25_beta_25", 38.80}, {"gamma_75_mixed", 41.65}, {"gamma_110_mixed", -37.39},
      {"dhfg_transverse", 20.99},  {"dhfg_normal", 21.16},    {"beta_1e_6", 89.99}};
  for (const auto& [name, printed] : rows) {
    const auto fold = fold_deg(case_named(name).surface());
    ASSERT_TRUE(fold) << name;
    EXPECT_NEAR(*fold, printed, 6e-3) << name;
  }
  for (const char* name : {"spur_25_88", "few_teeth", "few_teeth_low", "sixty_teeth", "module_0_2", "alpha_14_5",
                           "offset_45", "offset_minus_45", "offset_90", "gamma_60", "gamma_120", "offset_15"})
    EXPECT_FALSE(fold_deg(case_named(name).surface())) << name;
}

/// The column "stable": how fast Z grows with B where the flank is cut. The closed form stays tame where the usual
/// parameters run away.
TEST(FaceGearTable, GrowthOfTheClosedFormStaysAtThePrintedSize) {
  const std::vector<std::pair<const char*, double>> rows = {
      {"spur_25_88", 35}, {"beta_1e_6", 35},       {"beta_1e_10", 35},      {"beta_45", 95},
      {"few_teeth", 15},  {"few_teeth_low", 25},   {"many_teeth", 276},     {"sixty_teeth", 59},
      {"module_0_2", 32}, {"module_30", 45},       {"alpha_14_5", 53},      {"alpha_25_beta_25", 28},
      {"offset_45", 38},  {"offset_minus_45", 38}, {"offset_90", 41},       {"gamma_60", 47},
      {"gamma_120", 36},  {"gamma_75_mixed", 42},  {"gamma_110_mixed", 50}, {"dhfg_transverse", 77},
      {"dhfg_normal", 99}};
  for (const auto& [name, printed] : rows) {
    const auto c = case_named(name);
    const auto f = c.surface();
    const auto limits = zone_limits(f, c.module_mm);
    double most = 0;
    for (int n = 0; n <= 12; ++n)  // from undercut to pointing, fillet line to tip
      for (const int side : {1, -1}) {
        const double r = limits.inner_limit + (*limits.pointing_radius - limits.inner_limit) * n / 12;
        const auto low = face_gear::fillet_line_height(f, side, r);
        for (int k = 0; low && k <= 8; ++k)
          if (const auto at = face_gear::invert_flank(f, side, r, *low + (f.z_tip(r) - *low) * k / 8))
            most = std::max(most, std::abs(f.flank_Z_B(at->B)) / c.module_mm);
      }
    EXPECT_NEAR(most, printed, 0.6 + 0.01 * printed) << name;
  }
}

TEST(FaceGearTable, TheOffsetSampleWithEverySignOfItsOffset) {
  const auto limits_at = [](double offset) {
    auto c = case_named("offset_15");
    c.offset_mm = offset;
    return zone_limits(c.surface(), 3);
  };
  const auto minus = limits_at(-15), none = limits_at(0);
  EXPECT_NEAR(*minus.flanks[1].undercut_radius, 124.42744, 6e-6);
  EXPECT_NEAR(*minus.flanks[0].undercut_radius, 129.79653, 6e-6);
  EXPECT_NEAR(*minus.flanks[1].involute_start_radius, 128.62070, 6e-6);
  EXPECT_NEAR(*minus.flanks[0].involute_start_radius, 126.93583, 6e-6);
  EXPECT_NEAR(*minus.pointing_radius, 151.58330, 6e-6);
  EXPECT_NEAR(*minus.land_radius, 147.75491, 6e-6);
  EXPECT_NEAR(minus.inner_limit, 129.7965, 6e-5);
  for (const auto& flank : none.flanks) {
    EXPECT_NEAR(*flank.undercut_radius, 126.42263, 6e-6);
    EXPECT_NEAR(*flank.undercut_height, -38.00837, 6e-6);
    EXPECT_NEAR(*flank.involute_start_radius, 126.8976, 6e-5);
  }
  EXPECT_NEAR(*none.pointing_radius, 150.84431, 6e-6);

  const auto f = case_named("offset_15").surface();
  EXPECT_NEAR(f.shaper.r_b, 35.238473, 6e-7);
  EXPECT_NEAR(f.shaper.theta_0, 0.0479274692, 6e-11);
  EXPECT_NEAR(f.shaper.theta_t, 0.6085178231, 6e-11);
  EXPECT_NEAR(f.M2, 124.039426, 6e-7);
  EXPECT_NEAR(f.L_p, 132, 1e-12);
  EXPECT_NEAR(f.z_tip(140), -34.5, 1e-12);
  EXPECT_NEAR(*face_gear::root_height(f, 140), -41.25, 1e-12);
}

}  // namespace
}  // namespace toothpath::test
