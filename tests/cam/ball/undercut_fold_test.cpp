// Gears whose pitch point lies beyond the fold of the undercut (few teeth against the shaper's, low pressure angles,
// strong helices): the space is found wherever a plain search finds a regular flank, and nowhere else.
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath {
namespace {

using Surface = face_gear::FaceGearSurface<double>;

/// Teeth and shaper of the band where Newton from the pitch point used to fail, and a helix; no ring yet.
face_gear::FaceGearParameters teeth_of_the_band(test::Random& random, double& helix) {
  face_gear::FaceGearParameters g;
  g.teeth = 30 + int(random.index(91));
  g.shaper_teeth = int(std::lround(g.teeth * random(0.45, 0.65)));
  g.module_mm = std::exp(random(std::log(0.5), std::log(6.0)));
  g.module_plane = random(0, 1) < 0.5 ? face_gear::ModulePlane::transverse : face_gear::ModulePlane::normal;
  g.pressure_angle_rad = radians(random(14.5, 17.5));
  g.shaft_angle_rad = random(0, 1) < 0.5 ? radians(90) : radians(random(75, 105));
  g.shaper_tip_radius_mm = random(0.1, 0.3) * g.module_mm;
  helix = radians(random(18, 34)) * (random(0, 1) < 0.5 ? 1 : -1);
  return g;
}

/// A ring of them.
face_gear::FaceGearParameters gear_beyond_the_fold(test::Random& random) {
  double helix = 0;
  face_gear::FaceGearParameters g = teeth_of_the_band(random, helix);
  // Rings about the inner limit: some begin inside the fold.
  if (!face_gear::check_shaper(g, helix)) return g;
  const auto limits = face_gear::zone_limits(face_gear::make_surface<double>(g, helix), g.module_mm);
  const double inner = limits.hard_inner_limit + g.module_mm * random(-0.15, 0.8);
  const double most = limits.pointing_radius.value_or(inner + 3 * g.module_mm);
  g.zones = {{helix, inner, inner + random(0.2, 1.02) * std::max(most - inner, 0.1 * g.module_mm)}};
  return g;
}

double radius_of(const Surface& f, int side, double theta, double B) {
  const Vec3 P = f.flank_housing(side, theta, B);
  return std::hypot(P.x(), P.y());
}

/// B in J > 0 with the flank line of this theta at the radius: every 0.002 rad is looked at, up to the fold itself. The
/// largest s B counts: the sheet that is cut is the outermost.
std::optional<double> searched_B(const Surface& f, int side, double theta, double r) {
  constexpr double kStep = 2e-3, kWidest = radians(79);
  const auto J = [&](double b) { return f.flank_J(side, theta, side * b); };
  const auto e = [&](double b) { return radius_of(f, side, theta, side * b) - r; };
  for (double high = kWidest; high > -kWidest; high -= kStep) {
    double low = high - kStep;
    if (J(high) <= 0) continue;
    for (double good = high, bad = low; J(low) <= 0 && good - bad > 1e-14;) {
      const double middle = 0.5 * (good + bad);
      (J(middle) > 0 ? good : bad) = middle;
      if (good - bad <= 1e-14) low = good;
    }
    if (e(high) * e(low) > 0) continue;
    double from = high, to = low;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (from + to);
      (e(middle) * e(high) > 0 ? from : to) = middle;
    }
    return side * 0.5 * (from + to);
  }
  return {};
}

/// The flank of a side at a radius, from the fillet line up to the tip surface: is every place of it regular, and does
/// the solid shaper leave it? Beyond theta = 0 the flank goes on as the other one, which no shaper cuts (FaceGear warns
/// of it). Where the sheet ends the search goes on with another one: B jumps.
enum class Flank { regular, folded, cut };
Flank searched_flank(const face_gear::FaceGearParameters& gear, const Surface& f, int side, double r) {
  const double z_tip = f.z_tip(r);
  const test::BruteForceFaceGear brute(gear, gear.zones.front().helix_angle_rad);
  constexpr int kPlaces = 40;
  const double step = f.shaper.theta_t / kPlaces;
  bool cut = false;
  std::optional<double> before;
  for (int k = 0; k <= 2 * kPlaces; ++k) {
    const double theta = f.shaper.theta_t - k * step;
    const auto B = searched_B(f, side, theta, r);
    if (!B || (before && std::abs(*B - *before) > 0.1)) return Flank::folded;
    before = B;
    const Vec3 P = f.flank(side, theta, *B).p;
    if (P.z() > z_tip) return k == 0 ? Flank::folded : cut ? Flank::cut : Flank::regular;
    if (k % 8 == 0 && theta >= 0) cut = cut || brute.least_clearance(P) < -2e-4 * gear.module_mm;
  }
  return Flank::folded;
}

/// Five sections of the ring, both sides: the worst.
Flank searched_ring(const face_gear::FaceGear& gear) {
  const auto& zone = gear.rings().front().zone;
  Flank worst = Flank::regular;
  for (const int side : {1, -1})
    for (int n = 0; n <= 4 && worst == Flank::regular; ++n)
      worst = searched_flank(gear.parameters(), gear.rings().front().surface, side,
                             zone.inner_radius_mm + n * 0.25 * (zone.outer_radius_mm - zone.inner_radius_mm));
  return worst;
}

TEST(UndercutFold, SpacesAreFoundWhereASearchFindsARegularFlank) {
  test::Random random(2026);
  int accepted = 0, refused = 0, beyond = 0;
  for (int k = 0; k < 160; ++k) {
    const auto parameters = gear_beyond_the_fold(random);
    auto made = parameters.zones.empty() ? Expected<face_gear::FaceGear, std::vector<Refusal>>(std::vector<Refusal>{})
                                         : face_gear::FaceGear::make(parameters);
    if (made.refused()) {
      ++refused;
      continue;
    }
    const face_gear::FaceGear gear = std::move(made).value();
    const auto& ring = gear.rings().front();
    const auto& f = ring.surface;
    SCOPED_TRACE(fmt::format("{}: {}/{} teeth, {:.2f} deg, helix {:.2f} deg, ring {:.3f} to {:.3f}", k,
                             parameters.shaper_teeth, parameters.teeth, degrees(parameters.pressure_angle_rad),
                             degrees(ring.zone.helix_angle_rad), ring.zone.inner_radius_mm, ring.zone.outer_radius_mm));
    for (const int side : {1, -1}) beyond += f.flank_J(side, std::tan(f.shaper.alpha_t), side * f.shaper.alpha_t) <= 0;
    const analytic::GearDistance part(face_gear::part_of(gear), 1.0);
    accepted += !part.refusal();
    EXPECT_EQ(!part.refusal(), searched_ring(gear) == Flank::regular)
        << (part.refusal() ? part.refusal()->diagnostic.message : "accepted");
  }
  std::printf("%d accepted, %d refused as gears, %d flanks with the pitch point beyond the fold\n", accepted, refused,
              beyond);
  EXPECT_GE(accepted, 60);
  EXPECT_GE(refused, 10);
  EXPECT_GE(beyond, 10);
}

/// Why a gear is refused, by its numbers or by the search for its surfaces; nothing where it is taken.
std::optional<std::string> refusal_of(const face_gear::FaceGearParameters& parameters) {
  auto made = face_gear::FaceGear::make(parameters);
  if (made.refused()) return made.refused()->front().diagnostic.message;
  const face_gear::FaceGear gear = std::move(made).value();
  const analytic::GearDistance part(face_gear::part_of(gear), 1.0);
  if (part.refusal()) return part.refusal()->diagnostic.message;
  return {};
}

/// Does any material stand at the height of the tip surface at this radius? The swept shaper is asked all around.
bool has_land(const face_gear::FaceGearParameters& gear, double r, double z_tip) {
  constexpr int kPlaces = 200;
  const test::BruteForceFaceGear brute(gear, gear.zones.front().helix_angle_rad);
  const double step = 2 * kPi / gear.teeth / kPlaces;
  const auto spare = [&](double a, double enough = -INFINITY) {
    return brute.least_clearance(Vec3(r * std::cos(a), r * std::sin(a), z_tip), enough);
  };
  for (int k = 0; k < kPlaces; ++k)
    if (spare(k * step, 0) > 0) return true;
  // A land thinner than a step: one tooth, one maximum.
  double most = -INFINITY, at = 0;
  for (int k = 0; k < kPlaces; ++k)
    if (const double here = spare(k * step); here > most) most = here, at = k * step;
  double a = at - step, b = at + step;
  while (most <= 0 && b - a > 1e-9) {
    const double p = a + (b - a) / 3, q = b - (b - a) / 3, at_p = spare(p), at_q = spare(q);
    most = std::max({most, at_p, at_q});
    (at_p < at_q ? a : b) = at_p < at_q ? p : q;
  }
  return most > 0;
}

// Thin rings from far inside to far outside: taken exactly where a plain search and the swept shaper find both flanks
// whole and a land on the tooth.
TEST(UndercutFold, ThinRingsAreRefusedOnlyWhereThereIsNoTooth) {
  test::Random random(45);
  int taken = 0, refused = 0;
  for (int k = 0; k < 40; ++k) {
    double helix = 0;
    auto g = teeth_of_the_band(random, helix);
    if (!face_gear::check_shaper(g, helix)) continue;
    const auto f = face_gear::make_surface<double>(g, helix);
    for (int n = 0; n < 6; ++n) {
      const double r = std::hypot(f.L_p, f.shaper.r_p) * random(0.85, 1.2);
      g.zones = {{helix, r, r + 1e-3 * g.module_mm}};
      SCOPED_TRACE(fmt::format("{}: {}/{} teeth, {:.2f} deg, helix {:.2f} deg, shaft {:.2f} deg, radius {:.4f} mm", k,
                               g.shaper_teeth, g.teeth, degrees(g.pressure_angle_rad), degrees(helix),
                               degrees(g.shaft_angle_rad), r));
      const auto words = refusal_of(g);
      (words ? refused : taken) += 1;
      const bool whole = searched_flank(g, f, 1, r) == Flank::regular && searched_flank(g, f, -1, r) == Flank::regular;
      EXPECT_EQ(!words, whole && has_land(g, r, f.z_tip(r))) << words.value_or("taken");
    }
  }
  std::printf("%d taken, %d refused\n", taken, refused);
  EXPECT_GE(taken, 20);
  EXPECT_GE(refused, 60);
}

/// Rings that begin hardly outside their limit.
struct CloseRing {
  int shaper_teeth, teeth;
  double module, helix_deg, tip_radius, beyond_limit, width, ball;
};
face_gear::FaceGearParameters gear_of(const CloseRing& c) {
  face_gear::FaceGearParameters g;
  g.shaper_teeth = c.shaper_teeth;
  g.teeth = c.teeth;
  g.module_mm = c.module;
  g.module_plane = face_gear::ModulePlane::normal;
  g.pressure_angle_rad = radians(14.5);
  g.shaper_tip_radius_mm = c.tip_radius;
  const double helix = radians(c.helix_deg);
  const double inner =
      face_gear::zone_limits(face_gear::make_surface<double>(g, helix), g.module_mm).hard_inner_limit + c.beyond_limit;
  g.zones = {{helix, inner, inner + c.width}};
  return g;
}

struct ClosePlan {
  analytic::GearDistance part;
  Expected<plan::MillingPlan, ball::PlanRefusal> plan;
};
ClosePlan plan_of(const face_gear::FaceGearParameters& parameters, double ball) {
  const auto tool = test::ball_mill(ball, 5, 0.95 * ball, 14, 10);
  analytic::GearDistance part(face_gear::part_of(test::made(parameters)), ball::reach_of({tool}));
  auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.03, 0.002)}, {});
  return {std::move(part), std::move(plan)};
}

// Where the ball does not come to the inner end the refusal tells value and limit, and which ball and which inner
// radius would do. Those do.
TEST(UndercutFold, CloseToTheLimitARefusalTellsWhatWouldDo) {
  const CloseRing c{34, 100, 1.25, 60, 0.304, 0.05, 0.4, 0.519};
  auto gear = gear_of(c);
  const auto refused = plan_of(gear, c.ball).plan;
  ASSERT_FALSE(refused.has_value());
  const std::string words = refused.refused()->diagnostic.message;
  SCOPED_TRACE(words);
  EXPECT_NE(words.find("mm are missing at its inner end"), std::string::npos);
  const double ball = test::number_after(words, "would do, planned as a trial: a diameter of "),
               inner = test::number_after(words, "an inner_radius of ");
  EXPECT_GT(inner, gear.zones.front().inner_radius_mm);
  if (!std::isnan(ball)) {
    EXPECT_LT(ball, c.ball);
    EXPECT_TRUE(plan_of(gear, ball).plan.has_value());
  }
  gear.zones.front().inner_radius_mm = inner;
  EXPECT_TRUE(plan_of(gear, c.ball).plan.has_value());
}

// Where it comes there, the ring is planned: beside the undercut the end edge bends quickly, which is no cut.
TEST(UndercutFold, CloseToTheLimitABallThatComesThereCutsNothing) {
  for (const double beyond : {0.005, 0.0718}) {
    const CloseRing c{42, 179, 1.447, -60, 0.367, beyond, 0.4, 0.476};
    const ClosePlan at = plan_of(gear_of(c), c.ball);
    ASSERT_TRUE(at.plan.has_value()) << at.plan.refused()->diagnostic.message;
    double deepest = 0;
    for (const auto& path : at.plan->paths)
      for (const auto& record : path.records)
        deepest =
            std::max(deepest, 0.5 * c.ball - at.part.nearest(record.tip + 0.5 * c.ball * record.axis, c.ball).distance);
    EXPECT_LE(deepest, 0.001);
  }
}

}  // namespace
}  // namespace toothpath
