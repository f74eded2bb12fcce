// The distance to the finished gear against dense sampling of its exact surfaces.
#include "cam/analytic/gear_distance.h"

#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"
#include "tests/support/face_part.h"

namespace toothpath {
namespace {

using test::BruteForceGearSolid;

class Distance : public testing::TestWithParam<std::string> {
 protected:
  face_gear::FaceGear gear = test::made(test::gear_named(GetParam()));
  double reach = 0.9 * gear.parameters().module_mm;
  analytic::GearDistance part{face_gear::part_of(gear), reach};
  BruteForceGearSolid brute{gear};
};

/// What a query may differ: facets decide where nothing else does, and edges are polylines.
void expect_agreement(const analytic::GearDistance& part, const analytic::NearestPlace& q,
                      const test::BruteNearest& truth, double within, const char* where) {
  SCOPED_TRACE(fmt::format("{}: ({:.9f}, {:.9f}, {:.9f}), nearest {} at {:.9f}, brute force {} at {:.9f}", where,
                           q.point.x(), q.point.y(), q.point.z(), q.patch, q.distance, truth.patch, truth.distance));
  const double target = std::min(truth.distance, within);
  EXPECT_LE(q.distance, target + 2e-7);  // never above the truth
  EXPECT_GE(q.distance, target - (q.exact ? 2e-6 : 1e-4 + 2 * part.cell_sag_mm()));
}

TEST_P(Distance, PointsOverEveryPatch) {
  test::Random random(7);
  const double within = reach;
  for (int zone = 0; zone < part.zones(); ++zone) {
    for (int patch = 0; patch < 9; ++patch) {
      if (patch == 8 && zone + 1 == part.zones()) continue;
      for (int k = 0; k < 24; ++k) {
        // A third of the points above borders and corners of the patch.
        double x = random(0, 1), y = random(0, 1);
        if (k % 3 == 1) y = random(0, 1) < 0.5 ? 0 : 1;
        if (k % 3 == 2) x = random(0, 1) < 0.5 ? 0 : 1;
        if (patch == 6 || patch == 7) y *= 0.6;  // the samples of an end stop some way below the root
        const double d = std::pow(10.0, random(-5, 0)) * within;
        Vec3 n = brute.normal(zone, patch, x, y);
        if (k % 4 == 3) n = (n + 0.7 * Vec3(random(-1, 1), random(-1, 1), random(-1, 1))).normalized();
        const Vec3 c = brute.point(zone, patch, x, y) + d * n;
        if (brute.inside(c)) continue;
        const auto truth = brute.nearest(c);
        if (truth.distance < 1e-7) continue;  // on another surface: inside or outside is a matter of rounding
        expect_agreement(part, part.nearest(c, within), truth, within, BruteForceGearSolid::name(patch));
      }
    }
  }
}

TEST_P(Distance, FreeSpace) {
  test::Random random(11);
  const double h = gear.parameters().module_mm;
  int asked = 0;
  for (int k = 0; k < 400 && asked < 150; ++k) {
    const double r = random(gear.inner_radius() - 0.8 * h, gear.outer_radius() + 0.8 * h), a = random(-3.1415, 3.1415);
    const double z = random(gear.lowest_root(), gear.blank_top() + 0.7 * h);
    const Vec3 c(r * std::cos(a), r * std::sin(a), z);
    if (brute.inside(c)) continue;
    ++asked;
    expect_agreement(part, part.nearest(c, reach), brute.nearest(c), reach, "free space");
  }
  EXPECT_GE(asked, 50);
}

TEST_P(Distance, InsideIsNegative) {
  test::Random random(13);
  const double h = gear.parameters().module_mm;
  int deep = 0;
  for (int k = 0; k < 600; ++k) {
    const double r = random(gear.inner_radius() - 0.1 * h, gear.outer_radius() + 0.1 * h), a = random(-0.1, 0.1);
    const Vec3 c(r * std::cos(a), r * std::sin(a), random(gear.lowest_root() - 0.3 * h, gear.blank_top()));
    const bool inside = brute.inside(c);
    const auto q = part.nearest(c, reach);
    if (inside) {
      const auto truth = brute.nearest(c);
      if (truth.distance < 2e-4) continue;
      ++deep;
      EXPECT_LT(q.distance, 0) << c.transpose() << " truth " << truth.distance << " " << truth.patch << " said "
                               << q.patch;
    } else if (q.distance < 0) {
      const auto truth = brute.nearest(c);
      EXPECT_LT(truth.distance, 2e-4) << c.transpose() << " is free, " << truth.patch << " said " << q.distance << " "
                                      << q.patch;
    }
  }
  EXPECT_GE(deep, 50);
}

TEST_P(Distance, DepthBelowTheSurface) {
  test::Random random(17);
  for (int zone = 0; zone < part.zones(); ++zone)
    for (int patch = 0; patch < 5; ++patch)
      for (int k = 0; k < 20; ++k) {
        const double x = random(0.05, 0.95), y = random(0.1, 0.9), d = std::pow(10.0, random(-5, -2)) * reach;
        const Vec3 c = brute.point(zone, patch, x, y) - d * brute.normal(zone, patch, x, y);
        EXPECT_NEAR(part.nearest(c, reach).distance, -d, 2e-6) << BruteForceGearSolid::name(patch);
      }
}

// On either side of the surface, beside it and above it: never more than is true, and close.
TEST_P(Distance, FacetsKeepBelowTheTruth) {
  test::Random random(29);
  const double h = gear.parameters().module_mm, within = 0.6 * reach;
  int near = 0;
  for (int k = 0; k < 4000; ++k) {
    const double r = random(gear.inner_radius() - h, gear.outer_radius() + h), a = random(-3.1415, 3.1415);
    const Vec3 c(r * std::cos(a), r * std::sin(a), gear.blank_top() + random(-2.2, 1.0) * h);
    const auto truth = part.nearest(c, within);
    const double keeps = part.surface_keeps(c, within);
    if (truth.distance < 0 && !truth.exact) continue;  // somewhere inside
    EXPECT_LE(keeps, std::abs(truth.distance) + 2e-7) << c.transpose() << " " << truth.patch;
    // Quads go on beyond ends and tips, by less than a cell: away from there, in a space, only the sag is lost.
    const double beside = std::min(r - gear.inner_radius(), gear.outer_radius() - r);
    const double tip =
        test::sheet_of(part.space(0)).surface().z_tip(std::clamp(r, gear.inner_radius(), gear.outer_radius()));
    if (part.zones() > 1 || truth.distance < 0 || truth.distance >= within || beside < 0.5 + truth.distance) continue;
    if (c.z() > tip - 0.5 - truth.distance) continue;
    ++near;
    EXPECT_GE(keeps, std::abs(truth.distance) - 0.012) << c.transpose() << " " << truth.patch;
  }
  if (part.zones() == 1) { EXPECT_GT(near, 20); }
}

// Below the teeth the ring goes on, and what comes from the side meets it there.
TEST_P(Distance, FacetsKeepBelowTheTruthBelowTheTeeth) {
  test::Random random(37);
  const double h = gear.parameters().module_mm, within = 0.9 * reach;
  int near = 0;
  for (int k = 0; k < 2000; ++k) {
    const double beside = random(0, within), a = random(-3.1415, 3.1415);
    const double r = k % 2 == 0 ? gear.outer_radius() + beside : gear.inner_radius() - beside;
    const Vec3 c(r * std::cos(a), r * std::sin(a), gear.lowest_root() - random(-1, 20) * h);
    const auto truth = part.nearest(c, within);
    if (truth.distance < within) ++near;
    EXPECT_LE(part.surface_keeps(c, within), std::abs(truth.distance) + 2e-7) << c.transpose() << " " << truth.patch;
  }
  EXPECT_GT(near, 1000);
}

/// A line somewhere about the teeth, upright or leaning by up to half a radian: beside ends, in spaces, over lands and
/// groove, below the teeth.
struct Line {
  Vec3 from, axis;
  double length;
};
Line random_line(const face_gear::FaceGear& gear, test::Random& random, int k) {
  const double h = gear.parameters().module_mm, a = random(-3.1415, 3.1415);
  double r = random(gear.inner_radius() - h, gear.outer_radius() + h);
  if (k % 4 == 1) r = (k % 8 == 1 ? gear.outer_radius() : gear.inner_radius()) + random(-0.3, 0.6) * h;
  if (k % 4 == 2 && gear.rings().size() > 1)
    r = random(gear.rings()[0].zone.outer_radius_mm, gear.rings()[1].zone.inner_radius_mm) + random(-0.2, 0.2) * h;
  const double z =
      k % 4 == 1 && k % 3 == 0 ? gear.lowest_root() - random(0, 4) * h : gear.blank_top() + random(-2.2, 0.5) * h;
  const double lean = k % 2 == 0 ? random(0, 0.05) : random(0, 0.5), to = random(0, 6.28);
  return {Vec3(r * std::cos(a), r * std::sin(a), z),
          Vec3(std::sin(lean) * std::cos(to), std::sin(lean) * std::sin(to), std::cos(lean)),
          k % 7 == 0 ? random(0, 8) * h : random(0, 3) * h};
}

// Every place of a line keeps what is told of the line: in the space of its start, in the next one, and beside them.
TEST_P(Distance, LinesKeepBelowTheTruth) {
  test::Random random(43);
  const double within = 0.6 * reach;
  int near = 0, close = 0;
  for (int k = 0; k < 4000; ++k) {
    const Line line = random_line(gear, random, k);
    const double keeps = part.surface_keeps(line.from, line.axis, line.length, within);
    double truth = within;
    for (int n = 0; n <= 20; ++n) {
      const Vec3 c = line.from + n / 20.0 * line.length * line.axis;
      const auto q = part.nearest(c, within);
      if (q.distance >= 0 || q.exact) truth = std::min(truth, std::abs(q.distance));
    }
    EXPECT_LE(keeps, truth + 2e-7) << k << ": " << line.from.transpose() << ", " << line.axis.transpose();
    near += truth < within && truth > 0.1 * within;
    close += truth < within && truth > 0.1 * within && keeps > 0.8 * truth;
  }
  EXPECT_GT(near, 300);
  EXPECT_GT(close, near / 4);
}

// The same against dense samples of the exact surfaces: ball mills above every patch, upright and leaning.
TEST_P(Distance, LinesOverEveryPatchKeepBelowBruteForce) {
  test::Random random(47);
  const double within = 0.5 * reach;
  int near = 0;
  for (int zone = 0; zone < part.zones(); ++zone)
    for (int patch = 0; patch < 9; ++patch) {
      if (patch == 8 && zone + 1 == part.zones()) continue;
      for (int k = 0; k < 12; ++k) {
        double x = random(0, 1), y = random(0, 1);
        if (k % 3 == 1) y = random(0, 1) < 0.5 ? 0 : 1;
        if (k % 3 == 2) x = random(0, 1) < 0.5 ? 0 : 1;
        if (patch == 6 || patch == 7) y *= 0.6;
        const Vec3 from = brute.point(zone, patch, x, y) + random(0.01, 0.5) * within * brute.normal(zone, patch, x, y);
        const Vec3 axis = (Vec3::UnitZ() + random.vector(k % 2 == 0 ? 0.05 : 0.4)).normalized();
        const double length = random(0, 2.5) * gear.parameters().module_mm;
        const double keeps = part.surface_keeps(from, axis, length, within);
        near += keeps > 0 && keeps < within;
        for (int n = 0; n <= 6; ++n)
          EXPECT_LE(keeps, brute.nearest(from + n / 6.0 * length * axis).distance + 2e-7)
              << BruteForceGearSolid::name(patch) << " " << from.transpose() << ", " << axis.transpose();
      }
    }
  EXPECT_GT(near, 30);
}

// A conical root rises along the tooth: a short look that sees no surface must still tell air from material at every
// radius.
TEST(DistanceOnACone, ShortLooksTellAirFromMaterial) {
  face_gear::FaceGearParameters p;
  p.teeth = 79;
  p.shaper_teeth = 21;
  p.module_mm = 1.26;
  p.pressure_angle_rad = radians(20);
  p.shaft_angle_rad = radians(60);
  p.shaper_tip_radius_mm = 0.2306;
  p.reference_radius_mm = 54.81;
  p.zones = {{0, 54.81, 56.07}};
  const auto gear = test::made(p);
  const analytic::GearDistance part(face_gear::part_of(gear), 1.25);
  test::Random random(23);
  int free = 0, inside = 0;
  for (int k = 0; k < 6000; ++k) {
    const double r = random(gear.inner_radius(), gear.outer_radius()), a = random(0, gear.pitch());
    const double root = face_gear::root_height(gear.rings()[0].surface, r).value();
    const Vec3 c(r * std::cos(a), r * std::sin(a), root + random(-0.3, 1.0) * p.module_mm);
    const double within = random(0.02, 0.1), truth = part.nearest(c, 1.2).distance,
                 said = part.nearest(c, within).distance;
    if (truth > within + 1e-3) {
      ++free;
      EXPECT_EQ(said, within) << c.transpose() << " is " << truth << " away";
    } else if (truth < -1e-3) {
      ++inside;
      EXPECT_LT(said, 0) << c.transpose() << " is " << -truth << " deep";
    }
  }
  EXPECT_GT(free, 1000);
  EXPECT_GT(inside, 1000);
}

TEST_P(Distance, TheSameAtEveryTooth) {
  test::Random random(19);
  const int teeth = gear.parameters().teeth;
  for (int k = 0; k < teeth; ++k) {
    const int zone = int(random.index(std::size_t(part.zones()))), patch = int(random.index(6));
    const double x = random(0, 1), y = random(0, 1), d = random(0, reach);
    const Vec3 c = brute.point(zone, patch, x, y) + d * brute.normal(zone, patch, x, y);
    const Vec3 turned = toothpath::turned(c, k * gear.pitch());
    const auto q = part.nearest(c, reach), t = part.nearest(turned, reach);
    EXPECT_NEAR(q.distance, t.distance, q.exact && t.exact ? 1e-10 : 2e-5) << k << " " << q.patch << " " << t.patch;
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, Distance, testing::ValuesIn(test::gear_names()),
                         [](const auto& gear_case) { return gear_case.param; });

}  // namespace
}  // namespace toothpath
