// The bounds that shank and holder are proven with: interval arithmetic holds what it must, and the quads of the body
// patches hold the surface, by random places of the patches and by an independent sampling of the solid.
#include "cam/analytic/body_patches.h"

#include "cam/analytic/gear_distance.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"

namespace toothpath {
namespace {

using test::BruteForceGearSolid;

TEST(Interval, HoldsEveryFunctionOfItsPoints) {
  test::Random random(4);
  const auto some = [&] {
    const double a = random(-4, 4), b = a + std::pow(10.0, random(-6, 0.6));
    return Interval(a, b);
  };
  for (int k = 0; k < 4000; ++k) {
    const Interval x = some(), y = some();
    const double p = random(x.low, x.high), q = random(y.low, y.high);
    const auto expect = [&](const Interval& r, double value, const char* what) {
      EXPECT_TRUE(r.holds(value)) << what << " of " << p << ", " << q << " is " << value << ", not in [" << r.low
                                  << ", " << r.high << "]";
    };
    expect(x + y, p + q, "sum");
    expect(x - y, p - q, "difference");
    expect(x * y, p * q, "product");
    expect(x / y, p / q, "quotient");
    expect(sin(x), std::sin(p), "sin");
    expect(cos(x), std::cos(p), "cos");
    expect(tan(x), std::tan(p), "tan");
    expect(atan(x), std::atan(p), "atan");
    if (x.low >= 0) expect(sqrt(x), std::sqrt(p), "sqrt");
    if (std::abs(p) <= 1) expect(acos(x), std::acos(p), "acos");
    expect(atan2(y, x), std::atan2(q, p), "atan2");
  }
}

TEST(Interval, IsNarrowOnNarrowArguments) {
  for (const double x : {-3.0, -1.2, 0.3, 0.9, 2.7}) {
    const Interval s = sin(Interval(x, x + 1e-7)), c = cos(Interval(x)) * Interval(x);
    EXPECT_LE(s.high - s.low, 1.1e-7);
    EXPECT_LE(c.high - c.low, 1e-14);
  }
  EXPECT_FALSE((Interval(1) / Interval(-1, 1)).finite());
}

class Patches : public testing::TestWithParam<std::string> {
 protected:
  face_gear::FaceGear gear = test::made(test::gear_named(GetParam()));
  analytic::GearDistance part{face_gear::part_of(gear), 1.0};
};

TEST_P(Patches, NothingRestsOnSampling) { EXPECT_EQ(part.unproven(), 0U); }

/// The same gears with some of every kind of modification that bends.
face_gear::FaceGearParameters modified_gear(const std::string& name) {
  auto g = test::gear_named(name);
  using modification::Kind;
  for (const Kind kind : {Kind::tip_relief, Kind::root_relief, Kind::end_relief, Kind::lead_crowning, Kind::twist}) {
    modification::Modification m;
    m.kind = kind;
    m.amount_mm = 0.0025 * g.module_mm;
    m.length_mm = 0.2 * g.module_mm;
    m.law = kind == Kind::tip_relief ? modification::Law::linear : modification::Law::parabolic;
    g.modifications.push_back(m);
  }
  return g;
}
class ModifiedPatches : public testing::TestWithParam<std::string> {
 protected:
  face_gear::FaceGear gear = test::made(modified_gear(GetParam()));
  analytic::GearDistance part{face_gear::part_of(gear), 1.0};
};

TEST_P(ModifiedPatches, NothingRestsOnSampling) { EXPECT_EQ(part.unproven(), 0U); }

/// Does a box reach as far along g as the place p?
testing::AssertionResult box_holds(const analytic::BodyBox& box, const Vec3& p, const Vec3& g) {
  const double beyond = std::abs(g.dot(p - box.centre)) - std::abs(g.dot(box.a)) - std::abs(g.dot(box.b)) - box.off;
  if (beyond <= 1e-9 && (p - box.centre).norm() <= box.radius + 1e-9) return testing::AssertionSuccess();
  return testing::AssertionFailure() << beyond << " beyond the box, " << (p - box.centre).norm() << " of " << box.radius
                                     << " from its centre";
}

/// A quad, halved at random some times, under a random direction: no place of its piece of the surface lies lower than
/// its corners less `above`, or farther from the place of the hull with the same weights than `sag`.
void expect_hulls_hold(const analytic::GearDistance& part) {
  test::Random random(23);
  for (int zone = 0; zone < part.zones(); ++zone) {
    const auto& patches = part.patches(zone);
    const std::size_t count = part.cells(zone).size();
    double least = INFINITY;
    for (int k = 0; k < 3000; ++k) {
      // Lands, ends and the floor come last.
      const std::size_t cell =
          k % 3 == 0 ? count - 1 - random.index(std::min<std::size_t>(count, 1500)) : random.index(count);
      analytic::BodyQuad q = patches.quad(cell);
      for (std::size_t n = random.index(6); n > 0; --n) q = patches.halved(cell, q)[random.index(2)];
      const double a = random(0, 1), b = random(0, 1);
      const auto mixed = [&](const auto& x) {
        return ((1 - b) * ((1 - a) * x[0] + a * x[1]) + b * ((1 - a) * x[3] + a * x[2])).eval();
      };
      const auto p = patches.settled(cell, mixed(q.at));
      if (!p) continue;
      const Vec3 g = Vec3(random(-1, 1), random(-1, 1), random(-1, 1)).normalized();
      const analytic::BodyHull hull = patches.outline(cell, q);
      double low = INFINITY;
      for (std::size_t n = 0; n < hull.count; ++n) low = std::min(low, g.dot(hull.corner[n].p));
      const bool cut = patches.surface(cell).sheet() && !(q.stands[0] && q.stands[1] && q.stands[2] && q.stands[3]);
      if (cut) continue;  // a place that was moved to a border may belong to a quad beside it
      EXPECT_GE(g.dot(*p), low - patches.above(cell, q, g) - 1e-11)
          << to_string(patches.surface(cell).piece) << " " << k;
      const analytic::BodyBox& box = patches.box(cell);
      for (const Vec3& along : {g, Vec3(box.a.cross(box.b).normalized())})
        EXPECT_TRUE(box_holds(box, *p, along)) << to_string(patches.surface(cell).piece) << " " << k;
      least = std::min(least, g.dot(*p) - low + patches.above(cell, q, g));
      // Bilinear weights stand for the hull; a quad that is no parallelogram lies beside them by less than its second
      // differences.
      const double skew = 0.25 * (q.corner[0] - q.corner[1] + q.corner[2] - q.corner[3]).norm();
      if (patches.surface(cell).sheet()) {
        EXPECT_LE((*p - mixed(q.corner)).norm(), patches.sag(cell, q) + 2 * skew + 1e-9);
      }
    }
    EXPECT_LE(least, 1e-3);  // not far off everywhere
  }
}
TEST_P(Patches, HullsHoldTheirPieces) { expect_hulls_hold(part); }
TEST_P(ModifiedPatches, HullsHoldTheirPieces) { expect_hulls_hold(part); }

/// Every place of the sampled solid lies in some cell's hull up to its sag: tried with many directions.
TEST_P(Patches, TheSolidIsCovered) {
  const BruteForceGearSolid brute(gear, 4, 4);
  test::Random random(29);
  std::vector<Vec3> directions;
  for (int k = 0; k < 60; ++k) directions.push_back(Vec3(random(-1, 1), random(-1, 1), random(-1, 1)).normalized());
  for (int zone = 0; zone < part.zones(); ++zone)
    for (int patch = 0; patch < 9; ++patch) {
      if (patch == 8 && zone + 1 == part.zones()) continue;
      for (int k = 0; k < 25; ++k) {
        const double x = k % 5 == 3 ? std::round(random(0, 1)) : random(0, 1),
                     y = k % 5 == 4 ? std::round(random(0, 1)) : random(0, 1);
        const Vec3 at = brute.point(zone, patch, x, y);
        if (at.z() < gear.lowest_root() - 0.45) continue;  // the ends are followed to 0.5 mm below the lowest root
        bool held = false;
        for (int tooth = -2; tooth <= 2 && !held; ++tooth) {
          const Vec3 p = turned(at, tooth * gear.pitch());
          for (int in = 0; in < part.zones() && !held; ++in) {
            const auto& patches = part.patches(in);
            part.cell_index(in).near(p, patches.search_margin() + 1e-6, [&](std::size_t cell, double radius) {
              if (held || (p - patches.box(cell).centre).norm() > patches.box(cell).radius + 1e-9) return radius;
              const analytic::BodyHull hull = patches.outline(cell, patches.quad(cell));
              if (hull.count == 0) return radius;
              held = std::all_of(directions.begin(), directions.end(), [&](const Vec3& g) {
                double low = INFINITY;
                for (std::size_t n = 0; n < hull.count; ++n) low = std::min(low, g.dot(hull.corner[n].p));
                return g.dot(p) >= low - patches.above(cell, patches.quad(cell), g) - 1e-8 &&
                       box_holds(patches.box(cell), p, g);
              });
              return radius;
            });
          }
        }
        EXPECT_TRUE(held) << BruteForceGearSolid::name(patch) << " of zone " << zone << " at " << at.transpose() << " ("
                          << x << ", " << y << ")";
      }
    }
}

/// Every place that is told lies on the solid.
TEST_P(Patches, SettledPlacesLieOnTheSolid) {
  const BruteForceGearSolid brute(gear, 24, 40);
  test::Random random(31);
  for (int zone = 0; zone < part.zones(); ++zone) {
    const auto& patches = part.patches(zone);
    const std::size_t count = part.cells(zone).size();
    for (int k = 0; k < 40; ++k) {
      const std::size_t cell =
          k % 2 == 0 ? count - 1 - random.index(std::min<std::size_t>(count, 1200)) : random.index(count);
      const auto& q = patches.quad(cell);
      const auto p = patches.settled(cell, 0.25 * (q.at[0] + q.at[1] + q.at[2] + q.at[3]));
      if (!p || p->z() < gear.lowest_root() - 0.2 * gear.parameters().module_mm)
        continue;  // far down an end: not sampled there
      EXPECT_LE(brute.nearest(*p).distance, 5e-6) << to_string(patches.surface(cell).piece) << " " << p->transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gears, ModifiedPatches, testing::ValuesIn(test::gear_names()),
                         [](const auto& gear_case) { return gear_case.param; });
INSTANTIATE_TEST_SUITE_P(Gears, Patches, testing::ValuesIn(test::gear_names()),
                         [](const auto& gear_case) { return gear_case.param; });

}  // namespace
}  // namespace toothpath
