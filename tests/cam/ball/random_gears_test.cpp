// Any face gear that is accepted gets passes or a refusal that names its reason: random gears with a fixed seed, and
// gears that were hard to begin on.
#include "cam/ball/finishing.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/face_part.h"

namespace toothpath {
namespace {

struct Asked {
  face_gear::FaceGearParameters gear;
  double ball_radius = 0, scallop = 0, allowance = 0;
};

/// Shaft angles 60 to 120 deg, offsets of both signs, helices, modules 0.5 to 6, 20 to 200 teeth; balls from slim to
/// wider than the fillet.
Asked random_gear(test::Random& random) {
  Asked a;
  auto& g = a.gear;
  g.teeth = 20 + int(random.index(181));
  g.shaper_teeth = std::max(12, int(g.teeth * random(0.12, 0.6)));
  g.module_mm = std::exp(random(std::log(0.5), std::log(6.0)));
  g.module_plane = random(0, 1) < 0.5 ? face_gear::ModulePlane::transverse : face_gear::ModulePlane::normal;
  g.pressure_angle_rad = radians(random(17, 28));
  g.shaft_angle_rad = random(0, 1) < 0.3 ? radians(90) : radians(random(60, 120));
  const double helix = random(0, 1) < 0.4 ? 0 : radians(random(-30, 30));
  const double pitch_radius = 0.5 * g.module_mm * g.teeth;
  g.offset_mm = random(0, 1) < 0.5 ? 0 : random(-0.15, 0.15) * pitch_radius / std::sin(g.shaft_angle_rad);
  g.shaper_tip_radius_mm = random(0.1, 0.35) * g.module_mm;
  const double middle =
      pitch_radius * (1 + double(g.shaper_teeth) / g.teeth * std::cos(g.shaft_angle_rad)) / std::sin(g.shaft_angle_rad);
  const double inner = middle + random(-2, 1) * g.module_mm;
  g.zones = {{helix, inner, inner + random(0.5, 5) * g.module_mm}};
  a.ball_radius = random(0.4, 1.5) * g.shaper_tip_radius_mm;
  a.scallop = random(0.01, 0.03) * g.module_mm;
  a.allowance = random(0, 1) < 0.3 ? random(0, 0.05) * g.module_mm : 0;
  return a;
}

ball::FinishingOptions options(const Asked& a) {
  ball::FinishingOptions o;
  o.ball_radius_mm = a.ball_radius;
  o.allowance_mm = a.allowance;
  o.scallop_mm = path::ByRegion<double>::everywhere(a.scallop);
  o.chord_mm = 0.002;
  o.run_out_mm = 0.5 * a.ball_radius;
  return o;
}

Result<ball::FinishingPasses> passes(const analytic::GearDistance& part, const Asked& a) {
  const auto& zone = test::sheet_of(part.space(0)).ring().zone;
  const double margin = a.ball_radius + a.allowance + 0.1;
  return plan_finishing(tooth_space::OffsetSheet(part.space(0), a.ball_radius + a.allowance,
                                                 zone.inner_radius_mm - margin, zone.outer_radius_mm + margin, 33),
                        options(a));
}

bool names_numbers(const std::string& text) {
  return text.size() > 20 && text.find_first_of("0123456789") != std::string::npos;
}

constexpr double kDeepest = 5e-4;  // of a contact, mm

/// Distance from a point to the two end edges of the space, sampled a micrometre apart on the exact surface.
double end_edge_distance(const face_gear::SpaceSheet& space, const Vec3& c) {
  const auto& zone = space.ring().zone;
  const tooth_space::OffsetSheet surface(space, 0, zone.inner_radius_mm, zone.outer_radius_mm, 9);
  double least = INFINITY;
  constexpr int kPoints = 10000;
  for (const double r : {surface.r_from(), surface.r_to()})
    for (int k = 0; k <= kPoints; ++k)
      if (const auto s = surface.raw(5.0 * k / kPoints, r)) least = std::min(least, (s->contact.p - c).norm());
  return least;
}

/// Deepest cut of the contacts of a plan, mm. The distance to an edge is short by the sag of its polyline: where that
/// alone is too deep, the edge itself decides.
double deepest(const analytic::GearDistance& part, const ball::FinishingPasses& plan, const Asked& a) {
  double cut = -INFINITY;
  for (const auto& pass : plan.passes)
    for (const auto& p : pass.points) {
      if (!p.centre.allFinite() || !p.contact.allFinite()) return INFINITY;
      if (!p.touching) continue;
      const double ball = a.ball_radius + a.allowance;
      const auto q = part.nearest(p.centre, ball + 0.01);
      if (std::isnan(q.distance)) return INFINITY;
      double d = q.distance;
      if (!q.exact && ball - d >= kDeepest && std::string_view(q.patch) == "end edge")
        d = end_edge_distance(test::sheet_of(part.space(q.zone)), p.centre);
      cut = std::max(cut, ball - d);
    }
  return cut;
}

TEST(RandomGears, APlanThatDoesNotCutOrARefusalWithItsReason) {
  test::Random random(20);
  int planned = 0, refused = 0;
  for (int k = 0; k < 36; ++k) {
    const Asked a = random_gear(random);
    SCOPED_TRACE(k);
    auto made = face_gear::FaceGear::make(a.gear);
    if (const auto* refusals = made.refused()) {
      ++refused;
      for (const auto& r : *refusals)
        EXPECT_TRUE(!r.key.empty() && names_numbers(r.diagnostic.message)) << r.diagnostic.message;
      continue;
    }
    const analytic::GearDistance part(face_gear::part_of(made.value()), 1.3 * a.ball_radius + 0.6);
    if (part.refusal()) {
      EXPECT_TRUE(names_numbers(part.refusal()->diagnostic.message));
      continue;
    }
    const auto plan = passes(part, a);
    if (!plan) {
      EXPECT_TRUE(names_numbers(plan.error().message)) << plan.error().message;
      continue;
    }
    ++planned;
    EXPECT_LT(deepest(part, *plan, a), kDeepest);
  }
  EXPECT_GE(planned, 6);
  EXPECT_GE(refused, 6);
}

Asked steep_gear(double inner, double outer) {
  Asked a;
  a.gear = test::steep_gear(70, inner, outer);
  a.ball_radius = 0.9;
  a.scallop = 0.06;
  return a;
}

TEST(SteepGears, EveryRingWithinTheLimitsIsFollowed) {
  for (const auto& [inner, outer] : {std::pair{76.0, 86.0}, {74.0, 87.0}, {74.0, 88.0}, {80.0, 81.0}, {73.7, 74.5}}) {
    const Asked a = steep_gear(inner, outer);
    SCOPED_TRACE(fmt::format("ring {} to {}", inner, outer));
    const face_gear::FaceGear gear = test::made(a.gear);
    const analytic::GearDistance part(face_gear::part_of(gear), 1.5);
    ASSERT_FALSE(part.refusal()) << part.refusal()->diagnostic.message;
    const auto plan = passes(part, a);
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_LT(deepest(part, *plan, a), kDeepest);
    // Every tenth contact is a point that the swept shaper just touches. Inside the involute start the tip corner is
    // not conjugate (the gear's own warning): there the flank may stand a little proud of what the shaper leaves, never
    // below it.
    const test::BruteForceFaceGear brute(a.gear, 0);
    const auto& ring = gear.rings()[0];
    std::size_t asked = 0;
    for (const auto& pass : plan->passes)
      for (std::size_t k = 0; k < pass.points.size(); k += 10) {
        const auto& p = pass.points[k];
        const double r = std::hypot(p.contact.x(), p.contact.y());
        if (!p.touching || p.contact.z() > ring.surface.z_tip(r)) continue;
        ++asked;
        const double clearance = brute.least_clearance(p.contact);
        EXPECT_LT(clearance, 1e-6) << p.contact.transpose();
        EXPECT_GT(clearance, r < ring.limits.inner_limit ? -0.01 : -1e-6) << p.contact.transpose();
      }
    EXPECT_GE(asked, 10u);
  }
}

TEST(EmptySheet, IsARefusalAndNoPoint) {
  const face_gear::FaceGear gear = test::made(steep_gear(76, 86).gear);
  const face_gear::SpaceSheet space(gear.parameters(), gear.rings()[0]);
  const tooth_space::OffsetSheet sheet(space, 0.9, 40, 50);  // far inside the undercut
  EXPECT_TRUE(sheet.empty());
  EXPECT_FALSE(sheet.raw(1.5, 45));
  EXPECT_FALSE(sheet.at(2.5, 45));
  const auto plan = plan_finishing(sheet, options(steep_gear(76, 86)));
  ASSERT_FALSE(plan);
  EXPECT_TRUE(names_numbers(plan.error().message)) << plan.error().message;
}

/// A ball that touches both walls of a root corner, or both flanks: at every ring radius the trimmed centres keep the
/// ball's radius.
TEST(WideBalls, TrimmedCentresKeepTheRadius) {
  for (const double R : {0.7, 0.75, 0.8, 0.85}) {
    const face_gear::FaceGear gear = test::made(test::small_spur());
    const analytic::GearDistance part(face_gear::part_of(gear), 1.7);
    const auto& space = test::sheet_of(part.space(0));
    const tooth_space::OffsetSheet sheet(space, R, 60 - R - 0.1, 65 + R + 0.1, 33);
    ASSERT_TRUE(sheet.has_gaps());
    double cut = 0;
    for (int j = 0; j <= 120; ++j) {
      const double r = sheet.r_from() + (sheet.r_to() - sheet.r_from()) * j / 120;
      const auto gaps = sheet.gaps(r);
      std::vector<double> sigmas;
      for (const auto& g : gaps) sigmas.insert(sigmas.end(), {g.from, g.to});
      for (int k = 0; k <= 20; ++k) sigmas.push_back(0.5 + 4.0 * k / 20);
      for (const double sigma : sigmas) {
        const auto s = sheet.at(sigma, r);
        if (!s || s->contact.p.z() > space.surface().z_tip(r)) continue;
        cut = std::max(cut, R - part.nearest(s->centre, R + 0.01).distance);
      }
    }
    EXPECT_LT(cut, 1e-4) << "ball radius " << R;
  }
}

// Beyond the end of the ring the ball comes between the walls of a corner that the ring itself does not have. The sheet
// jumps from one wall to the other there; a run-out that followed it went to and fro hundreds of times.
TEST(RunOut, NeverTurnsBack) {
  Asked a;
  auto& g = a.gear;
  g.teeth = 160;
  g.shaper_teeth = 31;
  g.module_mm = 1;
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(22.5);
  g.addendum_coefficient = 0.6;
  g.clearance_coefficient = 0.3;
  g.shaper_tip_radius_mm = 0.2;
  g.zones = {{radians(29.09), 91.27, 93.27}};
  a.ball_radius = 0.3;
  a.scallop = 0.004;
  const face_gear::FaceGear gear = test::made(g);
  const analytic::GearDistance part(face_gear::part_of(gear), a.ball_radius);
  ball::FinishingOptions o = options(a);
  o.chord_mm = 0.0002;
  const auto plan =
      plan_finishing(tooth_space::OffsetSheet(part.space(0), a.ball_radius, 91.27 - 0.4, 93.27 + 0.4, 33), o);
  ASSERT_TRUE(plan) << plan.error().message;
  for (const auto& pass : plan->passes) {
    double way = 0, across = (pass.points.back().centre - pass.points.front().centre).norm();
    for (std::size_t k = 1; k < pass.points.size(); ++k)
      way += (pass.points[k].centre - pass.points[k - 1].centre).norm();
    EXPECT_LT(way, 1.05 * across) << pass.points.size() << " points";
  }
}

}  // namespace
}  // namespace toothpath
