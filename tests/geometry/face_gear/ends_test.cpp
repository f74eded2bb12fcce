// Where flanks and fillets end in gears that are no longer ordinary: low teeth, no pointing radius, undercut that runs
// outwards.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/swept_solid.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

face_gear::FaceGearParameters with_zone(const FaceGearCase& c, double inner, double outer) {
  auto g = c.parameters();
  g.zones = {{c.beta(), inner, outer}};
  return g;
}

bool refused_with(const face_gear::FaceGearParameters& g, const std::string& key, const std::string& word) {
  const auto made = face_gear::FaceGear::make(g);
  const auto* refusals = made.refused();
  if (!refusals) return false;
  for (const auto& r : *refusals)
    if (r.key == key && r.diagnostic.message.find(word) != std::string::npos) return true;
  return false;
}

/// Every fillet query is answered, from starts near and far, with a point on the radius that the solid shaper just
/// touches.
TEST(FaceGearEnds, FilletIsFoundFromAnyStart) {
  int queries = 0;
  for (auto c : random_cases(99, 60)) {
    const auto f = c.surface();
    const auto limits = face_gear::zone_limits(f, c.module_mm);
    const BruteForceFaceGear solid(c.parameters(), c.beta());
    for (const double t : {0.001, 0.1, 1.0}) {
      const double r = limits.hard_inner_limit * (1 - t) + *limits.land_radius * t;
      const double near = (std::sqrt(r * r - f.E * f.E) + f.shaper.r_a * f.Cg) / f.Sg;
      for (const int side : {1, -1})
        for (const double u : {0.0, 0.02, 0.3, 1.0})
          for (const double start : {near, near + 3 * c.module_mm, 0.5 * near, 0.0}) {
            const double A = f.shaper.A_t + u * (f.shaper.A_e - f.shaper.A_t);
            const auto Z = face_gear::fillet_Z_at_radius(f, side, A, r, start);
            ASSERT_TRUE(Z) << c.name << " r " << r << " u " << u << " start " << start;
            const Vec3 p = f.fillet(side, A, *Z).p;
            EXPECT_NEAR(std::hypot(p.x(), p.y()), r, 2e-12 * r);
            EXPECT_NEAR(solid.least_clearance(p), 0, 1e-9 * c.module_mm) << c.name << " start " << start;
            ++queries;
          }
    }
  }
  EXPECT_GT(queries, 5000);
}

/// No flank exists inside the limit that is said to be hard: it is the largest of what bounds either flank, and its
/// name says which.
TEST(FaceGearEnds, HardLimitIsTheLargestOfAllAndNamed) {
  std::map<std::string, int> named;
  auto cases = random_cases(41, 60);
  for (auto c : cases)  // low teeth: the fillet reaches the tip before the flank is undercut
    for (const double addendum : {1.0, 0.5, 0.25}) {
      c.addendum = addendum;
      c.tip_radius_mm = 0;
      if (!face_gear::check_shaper(c.parameters(), c.beta())) continue;
      const auto f = c.surface();
      const auto limits = face_gear::zone_limits(f, c.module_mm);
      double hard = f.M2;
      std::string name = "base cylinder";
      for (const auto& flank : limits.flanks)
        if (flank.undercut_radius && *flank.undercut_radius > hard) hard = *flank.undercut_radius, name = "undercut";
      for (const auto& flank : limits.flanks)
        if (flank.flank_start_radius && *flank.flank_start_radius > hard)
          hard = *flank.flank_start_radius, name = "fillet up to the tip";
      EXPECT_EQ(limits.hard_inner_limit, hard) << c.name << " addendum " << addendum;
      EXPECT_GE(limits.inner_limit, hard);
      if (limits.inner_limit == hard) { EXPECT_EQ(limits.inner_limit_name, name); }
      ++named[name];
    }
  EXPECT_GE(named["undercut"], 5);
  EXPECT_GE(named["fillet up to the tip"], 5);
}

/// The judge inside the library and the one of the tests, which share no line, agree near the flank.
TEST(FaceGearEnds, SweptClearanceAgreesWithBruteForce) {
  for (const auto& c : random_cases(5, 10)) {
    const auto f = c.surface();
    const BruteForceFaceGear solid(c.parameters(), c.beta());
    for (const auto& at : trimmed_flank(f, c.module_mm, 3, 3)) {
      const auto q = f.flank(at.side, at.theta, at.B);
      for (const double off : {-0.02, -1e-4, 0.0, 1e-4, 0.02}) {
        const Vec3 p = q.p + off * c.module_mm * q.n;
        EXPECT_NEAR(face_gear::swept_clearance(f, p), solid.least_clearance(p) * solid.cos_base_helix(), 1e-11 * f.L_p)
            << c.name << " off " << off;
      }
      EXPECT_NEAR(face_gear::swept_clearance(f, q.p), 0, 1e-12 * f.L_p);
    }
  }
}

/// Stub teeth of a coarse shaper keep a land far beyond the pitch radius: a sound zone is no error because R2 is far
/// away.
TEST(FaceGearEnds, StubTeethAreAccepted) {
  FaceGearCase c{"low_teeth", 9, 61, 4.9, 27.8, 20.8, 51.6, 95.5, 0.33, false, 0, {}, {}, 0, 0};
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  const double inner = limits.inner_limit + c.module_mm, outer = inner + 2 * c.module_mm;
  ASSERT_GT(face_gear::tip_thickness(f, outer).value_or(0), 0.5 * c.module_mm);
  const auto made = face_gear::FaceGear::make(with_zone(c, inner, outer));
  EXPECT_TRUE(made.has_value()) << made.error().front().diagnostic.message;
}

/// Low teeth, many shaper teeth: outside `flank_end_radius` the fillet line stands above the tip surface.
TEST(FaceGearEnds, FlankThatEndsBeforePointing) {
  FaceGearCase c{"low", 58, 527, 4, 14.3, 41.9, 322.9, 84.5, 0.335, true, 2.387, {}, {}, 0, 0};
  const auto f = c.surface();
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  double end = INFINITY;
  for (const auto& flank : limits.flanks)
    if (flank.flank_end_radius) {
      EXPECT_NEAR(face_gear::fillet_line_height(f, flank.side, *flank.flank_end_radius).value(),
                  f.z_tip(*flank.flank_end_radius), 1e-9 * f.L_p);
      end = std::min(end, *flank.flank_end_radius);
    }
  ASSERT_LT(end, *limits.land_radius);
  EXPECT_TRUE(refused_with(with_zone(c, end - 10, end + 0.1), "zone[0].outer_radius", "no involute is left"));
  for (const auto& ordinary : {"spur_25_88", "offset_15", "dhfg_normal"})
    for (const auto& flank : face_gear::zone_limits(case_named(ordinary).surface(), 3).flanks)
      EXPECT_TRUE(!flank.flank_end_radius || *flank.flank_end_radius > case_named(ordinary).pointing) << ordinary;
}

/// A gear whose undercut corner runs outwards from R1c: a zone that starts just outside R1c is refused by the solid
/// shaper, one that starts a millimetre further out is not.
TEST(FaceGearEnds, UndercutBeyondTheCusp) {
  FaceGearCase c{"outwards", 54,   107,      1.30447, 19.8215, -43.8004, 12.6251, 103.368,
                 0.847233,   true, 0.307558, {},      {},      0,        0};
  const auto limits = face_gear::zone_limits(c.surface(), c.module_mm);
  const double R1c = limits.flanks[1].undercut_radius.value();
  EXPECT_TRUE(refused_with(with_zone(c, R1c + 1e-3, R1c + 2), "zone[0].inner_radius", "undercut beyond R1c"));
  const auto made = face_gear::FaceGear::make(with_zone(c, R1c + 1, R1c + 2));
  EXPECT_TRUE(made.has_value()) << made.error().front().diagnostic.message;
}

}  // namespace
}  // namespace toothpath::test
