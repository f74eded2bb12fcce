// Undercut, involute start and pointing against the printed tables, closed forms, and themselves.
#include <gtest/gtest.h>

#include "geometry/face_gear/limits.h"
#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

class Limits : public testing::TestWithParam<FaceGearCase> {};

void expect_limit(const std::optional<double>& value, double printed, double tolerance, const std::string& what) {
  if (std::isnan(printed)) {
    EXPECT_FALSE(value) << what << " = " << value.value_or(0);
    return;
  }
  ASSERT_TRUE(value) << what;
  EXPECT_NEAR(*value, printed, tolerance) << what;
}

TEST_P(Limits, AgreeWithTheTable) {
  const auto& c = GetParam();
  const auto limits = face_gear::zone_limits(c.surface(), c.module_mm);
  const double digit = c.module_mm > 20 ? 6e-4 : 6e-5;
  for (const int k : {0, 1}) {
    const auto& flank = limits.flanks[std::size_t(k)];
    EXPECT_EQ(flank.side, k == 0 ? 1 : -1);
    expect_limit(flank.undercut_radius, c.undercut[k], digit, "R1c");
    expect_limit(flank.involute_start_radius, c.involute_start[k], 6e-5, "R1b");
  }
  expect_limit(limits.pointing_radius, c.pointing, 6e-5, "R2");
  expect_limit(limits.land_radius, c.land, 6e-5, "R2'");
}

/// A cusp is a double zero of the motion: J vanishes there, and is positive just outside on the regular sheet.
TEST_P(Limits, UndercutIsWhereJVanishes) {
  const auto& c = GetParam();
  const auto f = c.surface();
  for (const auto& flank : face_gear::zone_limits(f, c.module_mm).flanks) {
    if (!flank.undercut_B) continue;
    const double scale = f.flank_J(flank.side, f.shaper.theta_t, *flank.undercut_B + flank.side * 0.1);
    EXPECT_LT(std::abs(f.flank_J(flank.side, f.shaper.theta_t, *flank.undercut_B)), 1e-12 * std::abs(scale));
    EXPECT_GT(f.flank_J(flank.side, f.shaper.theta_t, *flank.undercut_B + flank.side * 1e-6), 0);
    EXPECT_LT(f.flank_J(flank.side, f.shaper.theta_t, *flank.undercut_B - flank.side * 1e-6), 0);
  }
}

TEST_P(Limits, WholeFlankBetweenTheLimitsIsRegular) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  ASSERT_TRUE(limits.land_radius);
  EXPECT_LT(limits.inner_limit, *limits.land_radius);
  EXPECT_LT(*limits.land_radius, *limits.pointing_radius);
  EXPECT_LE(limits.hard_inner_limit, limits.inner_limit);
  const auto samples = trimmed_flank(f, c.module_mm, 9, 7);
  EXPECT_EQ(samples.size(), 2u * 9u * 7u);
  for (const auto& at : samples) {
    EXPECT_GT(f.flank_J(at.side, at.theta, at.B), 0);
    EXPECT_LE(at.theta, f.shaper.theta_t * (1 + 1e-12));
    EXPECT_GE(at.theta, 0);
  }
}

TEST_P(Limits, FilletLineLiesOnTheRadius) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  for (const int side : {1, -1}) {
    for (const double t : {0.01, 0.5, 0.99}) {
      const double r = limits.hard_inner_limit * (1 - t) + *limits.land_radius * t;
      const auto z = face_gear::fillet_line_height(f, side, r);
      ASSERT_TRUE(z) << "side " << side << " r " << r;
      const auto at = face_gear::invert_flank(f, side, r, *z);
      ASSERT_TRUE(at);
      // Near the cusp an error of position of 1e-14 r is a far larger one of theta.
      EXPECT_NEAR(at->theta, f.shaper.theta_t, 1e-7);
      const auto root = face_gear::root_height(f, r);
      ASSERT_TRUE(root);
      EXPECT_LT(*z, f.z_tip(r));
      EXPECT_GT(*z, *root);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Extreme, Limits, testing::ValuesIn(extreme_cases()), name_of_case);

/// Spur, right angle: i^2 theta cos^3 B [theta cos B - s (E/r_b + sin B)] = sin^2 B.
TEST(FaceGearLimits, SpurCuspSolvesTheClosedForm) {
  for (const char* name : {"spur_25_88", "offset_15", "offset_45", "few_teeth", "sixty_teeth", "alpha_14_5"}) {
    const auto c = case_named(name);
    const auto f = c.surface();
    for (const auto& flank : face_gear::zone_limits(f, c.module_mm).flanks) {
      if (!flank.undercut_B) continue;
      const double B = *flank.undercut_B, th = f.shaper.theta_t, cB = std::cos(B), sB = std::sin(B);
      const double left = f.i * f.i * th * cB * cB * cB * (th * cB - flank.side * (f.E / f.shaper.r_b + sB));
      EXPECT_NEAR(left, sB * sB, 1e-14) << name;
    }
  }
}

TEST(FaceGearLimits, TipRoundingMovesTheCusp) {
  struct Row {
    const char* name;
    double rho, plus, minus, tolerance;
  };
  for (const Row& row : std::vector<Row>{{"offset_15", 0.75, 124.360, 129.560, 6e-4},
                                         {"offset_15", 0.9, 124.346, 129.510, 6e-4},
                                         {"offset_15", 1.118, 124.326, 129.435, 6e-4},
                                         {"dhfg_transverse", 0.75, 447.490, 0, 6e-4},
                                         {"dhfg_transverse", 1.25, 447.071, 0, 6e-4},
                                         {"dhfg_transverse", 1.5, 446.856, 0, 6e-4},
                                         {"dhfg_transverse", 1.9, 446.502, 0, 6e-4},
                                         {"dhfg_normal", 0.75, 507.868, 0, 6e-4},
                                         {"dhfg_normal", 1.25, 507.479, 0, 6e-4},
                                         {"dhfg_normal", 1.5, 507.279, 0, 6e-4},
                                         {"dhfg_normal", 1.9, 506.954, 0, 6e-4}}) {
    auto c = case_named(row.name);
    c.tip_radius_mm = row.rho;
    const auto limits = face_gear::zone_limits(c.surface(), c.module_mm);
    ASSERT_TRUE(limits.flanks[0].undercut_radius);
    EXPECT_NEAR(*limits.flanks[0].undercut_radius, row.plus, row.tolerance) << row.name << " rho " << row.rho;
    if (row.minus > 0) {
      ASSERT_TRUE(limits.flanks[1].undercut_radius);
      EXPECT_NEAR(*limits.flanks[1].undercut_radius, row.minus, row.tolerance) << row.name << " rho " << row.rho;
    }
  }
}

TEST(FaceGearLimits, MoreShaperTeethNarrowTheBand) {
  const double transverse[3][2] = {{448.462, 496.152}, {448.826, 495.546}, {449.182, 494.960}};
  const double normal[3][2] = {{508.938, 583.898}, {509.436, 582.962}, {509.924, 582.062}};
  for (int k = 0; k < 3; ++k) {
    for (const bool plane : {false, true}) {
      auto c = case_named(plane ? "dhfg_transverse" : "dhfg_normal");
      c.shaper_teeth = 31 + k;
      const auto limits = face_gear::zone_limits(c.surface(), c.module_mm);
      EXPECT_NEAR(*limits.flanks[0].undercut_radius, (plane ? transverse : normal)[k][0], 6e-4);
      EXPECT_NEAR(*limits.land_radius, (plane ? transverse : normal)[k][1], 6e-4);
    }
  }
}

TEST(FaceGearLimits, LargestTipRadius) {
  const auto largest = [](const char* name) {
    const auto c = case_named(name);
    return std::pair(largest_tip_radius(c.parameters(), c.beta()),
                     face_gear::largest_active_tip_radius(c.parameters(), c.beta()));
  };
  EXPECT_NEAR(largest("offset_15").first, 1.118, 6e-4);
  EXPECT_NEAR(largest("dhfg_transverse").first, 1.9503, 6e-5);
  EXPECT_NEAR(largest("dhfg_transverse").second, 1.9503, 6e-5);
  EXPECT_NEAR(largest("dhfg_normal").first, 2.6276, 6e-5);
  EXPECT_NEAR(largest("dhfg_normal").second, 2.4046, 6e-5);
}

/// The heights and angles beside the radii: both samples.
TEST(FaceGearLimits, HeightsOfTheCusp) {
  const auto o = face_gear::zone_limits(case_named("offset_15").surface(), 3);
  EXPECT_NEAR(*o.flanks[0].undercut_height, -36.70443, 6e-6);
  EXPECT_NEAR(*o.flanks[1].undercut_height, -38.75334, 6e-6);
  EXPECT_NEAR(degrees(*o.flanks[0].undercut_B), 4.16994, 6e-6);
  EXPECT_NEAR(degrees(*o.flanks[1].undercut_B), -11.28481, 6e-6);
  EXPECT_STREQ(o.inner_limit_name, "undercut");
  EXPECT_NEAR(o.inner_limit, 129.7965, 6e-5);
  EXPECT_NEAR(*o.pointing_radius - o.inner_limit, 21.787, 6e-4);
  EXPECT_NEAR(*o.land_radius - o.inner_limit, 17.958, 6e-4);
  EXPECT_NEAR(*face_gear::zone_limits(case_named("dhfg_transverse").surface(), 5).flanks[0].undercut_height, -77.91915,
              6e-6);
  EXPECT_NEAR(*face_gear::zone_limits(case_named("dhfg_normal").surface(), 5).flanks[0].undercut_height, -88.70597,
              6e-6);
  EXPECT_STREQ(face_gear::zone_limits(case_named("few_teeth").surface(), 2).inner_limit_name, "involute start");
}

/// Near pointing the thickness falls linearly; both flanks meet at the printed azimuth.
TEST(FaceGearLimits, ThicknessNearPointing) {
  const auto f = case_named("offset_15").surface();
  const double R2 = *face_gear::zone_limits(f, 3).pointing_radius;
  EXPECT_NEAR(face_gear::tip_thickness(f, R2 - 1e-3).value(), 1.6105e-4, 6e-9);
  EXPECT_NEAR(face_gear::tip_thickness(f, R2 - 1e-6).value(), 1.6105e-7, 6e-12);
  EXPECT_LT(face_gear::tip_thickness(f, R2 + 1e-3).value(), 0);
  const auto at = face_gear::invert_flank(f, 1, R2, f.z_tip(R2));
  ASSERT_TRUE(at);
  EXPECT_NEAR(degrees(face_gear::flank_azimuth(f, 1, *at)), 5.697116, 6e-7);
}

TEST(FaceGearLimits, DegenerateQuestionsHaveNoAnswer) {
  const auto f = case_named("offset_15").surface();
  EXPECT_FALSE(face_gear::tip_thickness(f, f.M2));
  EXPECT_FALSE(face_gear::tip_thickness(f, 10));
  EXPECT_FALSE(face_gear::tip_thickness(f, -1));
  EXPECT_FALSE(face_gear::fillet_line_height(f, -1, 120));
  EXPECT_FALSE(face_gear::root_height(f, 15));
  EXPECT_FALSE(face_gear::root_height(f, 0));
  // Nothing throws or hangs on a gear that nobody can make.
  auto odd = case_named("offset_15");
  odd.offset_mm = 160;
  const auto limits = face_gear::zone_limits(odd.surface(), 3);
  EXPECT_GT(limits.inner_limit, 0);
}

/// Mirror: offset and helix reversed exchange the sides and nothing else.
TEST(FaceGearLimits, MirrorExchangesTheSides) {
  for (auto c : random_cases(77, 12)) {
    const auto a = face_gear::zone_limits(c.surface(), c.module_mm);
    c.offset_mm = -c.offset_mm;
    c.beta_deg = -c.beta_deg;
    const auto b = face_gear::zone_limits(c.surface(), c.module_mm);
    for (const int k : {0, 1}) {
      const auto &p = a.flanks[std::size_t(k)], &q = b.flanks[std::size_t(1 - k)];
      ASSERT_EQ(p.undercut_radius.has_value(), q.undercut_radius.has_value());
      if (p.undercut_radius) { EXPECT_NEAR(*p.undercut_radius, *q.undercut_radius, 1e-11 * a.inner_limit); }
      ASSERT_EQ(p.involute_start_radius.has_value(), q.involute_start_radius.has_value());
      if (p.involute_start_radius) {
        EXPECT_NEAR(*p.involute_start_radius, *q.involute_start_radius, 1e-11 * a.inner_limit);
      }
    }
    EXPECT_NEAR(*a.pointing_radius, *b.pointing_radius, 1e-10 * a.inner_limit);
  }
}

// The job's land: the radius where the tooth is that thick, between the pointed one and the one for 0.2 m.
TEST(FaceGearLimits, LeastLandOfTheGear) {
  const auto& c = case_named("offset_15");
  const auto usual = face_gear::zone_limits(c.surface(), c.module_mm),
             thin = face_gear::zone_limits(c.surface(), c.module_mm, 0.3);
  ASSERT_TRUE(usual.land_radius && thin.land_radius && thin.pointing_radius);
  EXPECT_DOUBLE_EQ(usual.practical_land_mm, 0.2 * c.module_mm);
  EXPECT_DOUBLE_EQ(thin.practical_land_mm, 0.3);
  EXPECT_LT(*usual.land_radius, *thin.land_radius);
  EXPECT_LT(*thin.land_radius, *thin.pointing_radius);
  EXPECT_NEAR(face_gear::tip_thickness(c.surface(), *thin.land_radius).value_or(0), 0.3, 1e-9);
}

}  // namespace
}  // namespace toothpath::test
