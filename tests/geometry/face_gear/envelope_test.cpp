// Flank, fillet and root against the sweep of the solid shaper: what the closed form calls the surface is exactly where
// material begins, for both sides, all shaft angles, offsets and helices.
#include <gtest/gtest.h>

#include <optional>

#include "tests/support/brute_force_face_gear.h"
#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

/// On the surface: 0. `step` into the material: positive. `step` out of it: negative.
void expect_on_surface(const BruteForceFaceGear& sweep, const Vec3& p, const Vec3& n, double scale, double step,
                       const std::string& where) {
  EXPECT_NEAR(sweep.least_clearance(p), 0.0, 1e-11 * scale) << where;
  EXPECT_GT(sweep.least_clearance(p - step * n), 0.1 * step) << where;
  EXPECT_LT(sweep.least_clearance(p + step * n), -0.1 * step) << where;
}

class Envelope : public testing::TestWithParam<FaceGearCase> {};

TEST_P(Envelope, FlankIsWhereMaterialBegins) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const BruteForceFaceGear sweep(c.parameters(), c.beta());
  const auto samples = trimmed_flank(f, c.module_mm, 7, 5);
  ASSERT_FALSE(samples.empty());
  for (const auto& at : samples) {
    const auto q = f.flank(at.side, at.theta, at.B);
    expect_on_surface(sweep, q.p, q.n, f.L_p, 1e-4 * c.module_mm,
                      fmt::format("side {} theta {} B {} r {}", at.side, at.theta, at.B, std::hypot(q.p.x(), q.p.y())));
  }
}

TEST_P(Envelope, DistanceInsideTheMaterialIsExact) {
  const auto& c = GetParam();
  const auto f = c.surface();
  const BruteForceFaceGear sweep(c.parameters(), c.beta());
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  const double depth = 0.02 * c.module_mm;
  int tried = 0;
  for (const auto& at : trimmed_flank(f, c.module_mm, 5, 5)) {
    const auto q = f.flank(at.side, at.theta, at.B);
    const double r = std::hypot(q.p.x(), q.p.y());
    if (r < limits.inner_limit + 0.5 * c.module_mm || at.theta > 0.85 * f.shaper.theta_t) continue;
    ++tried;
    const Vec3 inside = q.p - depth * q.n;
    EXPECT_NEAR(sweep.least_clearance(inside) * sweep.cos_base_helix(), depth, 1e-11 * f.L_p);
    const auto d = face_gear::flank_distance(f, at.side, inside);
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->distance, -depth, 1e-12 * f.L_p);
  }
  if (c.name != "few_teeth") { EXPECT_GT(tried, 0); }
}

TEST_P(Envelope, FilletAndRootAreWhereMaterialBegins) {
  for (const double share : {0.0, 0.5}) {
    auto c = GetParam();
    c.tip_radius_mm = share * largest_tip_radius(c.parameters(), c.beta());
    const auto f = c.surface();
    const BruteForceFaceGear sweep(c.parameters(), c.beta());
    const auto limits = face_gear::zone_limits(f, c.module_mm);
    ASSERT_TRUE(limits.land_radius);
    const double step = 1e-4 * c.module_mm;
    for (const double t : {0.05, 0.4, 0.75, 0.95}) {
      const double r = limits.hard_inner_limit * (1 - t) + *limits.land_radius * t;
      const double Z_start = (std::sqrt(r * r - f.E * f.E) + f.shaper.r_a * f.Cg) / f.Sg;
      for (const int side : {1, -1}) {
        for (const double u : {0.02, 0.35, 0.7, 0.97}) {
          const double A = f.shaper.A_t + u * (f.shaper.A_e - f.shaper.A_t);
          const auto Z = face_gear::fillet_Z_at_radius(f, side, A, r, Z_start);
          ASSERT_TRUE(Z) << c.name << " r " << r << " A " << A;
          const auto q = f.fillet(side, A, *Z);
          ASSERT_TRUE(q.defined);
          expect_on_surface(sweep, q.p, q.n, f.L_p, step,
                            fmt::format("fillet side {} A {} r {} rho {}", side, A, r, f.shaper.rho));
        }
      }
      // Middle and edges of the root land.
      const auto Z = face_gear::fillet_Z_at_radius(f, 1, f.shaper.A_e, r, Z_start);
      ASSERT_TRUE(Z);
      const auto root = f.root_meridian(*Z);
      const double from = f.root_edge_azimuth(1, *Z), to = f.root_edge_azimuth(-1, *Z);
      const double own = std::atan2(root.p.y(), root.p.x());
      EXPECT_NEAR(to - from, f.pitch - 2 * f.i * f.shaper.psi_c, 1e-12);
      for (const double u : {0.05, 0.5, 0.95}) {
        const double turn = from + u * (to - from) - own;
        expect_on_surface(sweep, turned(root.p, turn), turned(root.n, turn), f.L_p, step,
                          fmt::format("root r {} u {}", r, u));
      }
      const auto height = face_gear::root_height(f, std::hypot(root.p.x(), root.p.y()));
      ASSERT_TRUE(height);
      EXPECT_NEAR(*height, root.p.z(), 1e-12 * f.L_p);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Extreme, Envelope, testing::ValuesIn(extreme_cases()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Random, Envelope, testing::ValuesIn(random_cases(20240607, 8)), name_of_case);

/// Above R1c the fillet joins the flank; below it, its beginning is cut away by the other sheet or does not exist.
TEST(EnvelopeLimits, BelowTheUndercutRadiusTheBeginningOfTheFilletIsCutAway) {
  for (const char* name :
       {"offset_15", "dhfg_transverse", "gamma_75_mixed", "gamma_110_mixed", "spur_25_88", "offset_90"}) {
    for (const double share : {0.0, 0.6}) {
      auto c = case_named(name);
      c.tip_radius_mm = share * largest_tip_radius(c.parameters(), c.beta());
      const auto f = c.surface();
      const BruteForceFaceGear sweep(c.parameters(), c.beta());
      for (const auto& flank : face_gear::zone_limits(f, c.module_mm).flanks) {
        if (!flank.undercut_radius) continue;
        const double A = f.shaper.A_t + 1e-9, Z_cusp = f.flank_Z(flank.side, f.shaper.theta_t, *flank.undercut_B);
        const auto clearance_at = [&](double beyond) -> std::optional<double> {
          const auto Z =
              face_gear::fillet_Z_at_radius(f, flank.side, A, *flank.undercut_radius + beyond, Z_cusp + beyond);
          if (!Z) return {};
          return sweep.least_clearance(f.fillet(flank.side, A, *Z).p);
        };
        for (const double above : {0.003, 0.03, 0.3}) {
          const auto clearance = clearance_at(above * c.module_mm);
          ASSERT_TRUE(clearance) << name;
          EXPECT_NEAR(*clearance, 0, 1e-12 * f.L_p) << name << " side " << flank.side << " above by " << above << " m";
        }
        for (const double below : {0.1, 0.3}) {
          EXPECT_LT(clearance_at(-below * c.module_mm).value_or(-1), -1e-7)
              << name << " side " << flank.side << " below by " << below << " m";
        }
      }
    }
  }
}

/// Width of the uncut arc on the tip surface, by bisection on the swept solid alone.
TEST(EnvelopeLimits, TipThicknessAndPointingRadius) {
  for (const char* name : {"offset_15", "dhfg_transverse", "gamma_75_mixed", "gamma_120", "beta_45"}) {
    const auto c = case_named(name);
    const auto f = c.surface();
    const BruteForceFaceGear sweep(c.parameters(), c.beta());
    const auto limits = face_gear::zone_limits(f, c.module_mm);
    ASSERT_TRUE(limits.pointing_radius && limits.land_radius);
    const auto centre = [&](double r) {
      const auto at = face_gear::invert_flank(f, 1, r, f.z_tip(r)), on = face_gear::invert_flank(f, -1, r, f.z_tip(r));
      return 0.5 * (face_gear::flank_azimuth(f, 1, *at) + face_gear::flank_azimuth(f, -1, *on));
    };
    const auto uncut_at = [&](double r, double azimuth) {
      return sweep.least_clearance({r * std::cos(azimuth), r * std::sin(azimuth), f.z_tip(r)}) > 0;
    };
    for (const double r :
         {limits.inner_limit + 0.3 * c.module_mm, *limits.land_radius, *limits.pointing_radius - 1e-3}) {
      const double middle = centre(r);
      ASSERT_TRUE(uncut_at(r, middle)) << name;
      double width = 0;
      for (const double sign : {1.0, -1.0}) {
        double in = 0, out = 0.5 * f.pitch;
        for (int k = 0; k < 60; ++k) {
          const double x = 0.5 * (in + out);
          (uncut_at(r, middle + sign * x) ? in : out) = x;
        }
        width += in;
      }
      const auto S = face_gear::tip_thickness(f, r);
      ASSERT_TRUE(S);
      EXPECT_NEAR(r * width, *S, 1e-9 * c.module_mm) << name << " r " << r;
    }
    EXPECT_NEAR(face_gear::tip_thickness(f, *limits.land_radius).value(), 0.2 * c.module_mm, 1e-10 * f.L_p);
    const double beyond = *limits.pointing_radius + 1e-4 * c.module_mm, middle = centre(*limits.pointing_radius);
    for (int k = -200; k <= 200; ++k) EXPECT_FALSE(uncut_at(beyond, middle + f.pitch * k / 400)) << name;
  }
}

/// The check checks: a shaper one micrometre too long or a phase error of a micrometre is seen.
TEST(EnvelopeLimits, SeesPlantedErrors) {
  const auto c = case_named("offset_15");
  const auto f = c.surface();
  auto longer = c.parameters();
  longer.clearance_coefficient += 0.001 / 3;
  auto shifted = c.parameters();
  shifted.backlash_mm = 0.001;
  const BruteForceFaceGear good(c.parameters(), 0), deep(longer, 0), thin(shifted, 0);
  const auto flank = f.flank(1, 0.35, 0.5);
  const auto root = f.root_meridian(138.0);
  const double turn =
      0.5 * (f.root_edge_azimuth(1, 138.0) + f.root_edge_azimuth(-1, 138.0)) - std::atan2(root.p.y(), root.p.x());
  const Vec3 on_root = turned(root.p, turn);
  EXPECT_NEAR(good.least_clearance(flank.p), 0, 1e-11);
  EXPECT_NEAR(thin.least_clearance(flank.p), -0.0005, 1e-9);
  EXPECT_NEAR(good.least_clearance(on_root), 0, 1e-11);
  EXPECT_NEAR(deep.least_clearance(on_root), -0.001, 1e-9);
}

}  // namespace
}  // namespace toothpath::test
