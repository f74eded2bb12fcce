// The direction of the tool: upright where that is clear, a lean or a refusal with its reason where it is not.
#include "cam/ball/tool_direction.h"

#include "cam/tool/body.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"
#include "tests/support/plain_frustum.h"

namespace toothpath {
namespace {

TEST(Direction, UprightForPlainJobs) {
  for (const char* name : {"dhfg", "offset", "spur"})
    for (const auto& d : test::job_named(name).plan.directions) {
      EXPECT_TRUE(d.fixed);
      EXPECT_EQ(d.lean_rad, 0) << name;
      EXPECT_NE(d.explanation.find("draft"), std::string::npos) << d.explanation;
      EXPECT_GE(d.clearance_mm, 0.05);
      EXPECT_FALSE(d.candidates.empty());
    }
}

TEST(Direction, FatHolderOnAShortToolIsRefusedOrLeansAndSaysWhy) {
  const face_gear::FaceGear gear = test::made(test::offset_gear());
  auto tool = test::ball_mill(1.6, 4, 1.5, 5, 40);
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.05, 0.002)}, {});
  if (const auto* refusal = plan.refused()) {
    EXPECT_EQ(refusal->key, "operation[0].tool");
    EXPECT_NE(refusal->diagnostic.message.find("holder"), std::string::npos) << refusal->diagnostic.message;
    EXPECT_NE(refusal->diagnostic.message.find("no fixed direction"), std::string::npos) << refusal->diagnostic.message;
  } else {
    const auto& d = plan.value().directions.front();
    EXPECT_GT(d.lean_rad, 0);
    EXPECT_NE(d.explanation.find("leans"), std::string::npos);
  }
}

// Gaps are measured as far as the clearance asks.
TEST(Direction, AClearanceOfThreeMillimetresIsFound) {
  const auto tool = test::ball_mill(1, 12, 0.95, 24, 10);
  const face_gear::FaceGear gear = test::made(test::small_spur());
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  plan::Options options;
  options.limits.clearance_mm = 3;
  const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.05, 0.002)}, options);
  ASSERT_FALSE(plan.refused()) << plan.refused()->diagnostic.message;
  EXPECT_GE(plan.value().directions.front().clearance_mm, 3);
}

// At a shaft angle of 100 deg the normal of the pitch surface leans by 10 deg. Along it the flute of a tool that runs
// out of one ring would cut into the other, 1.4 mm away; the gear axis keeps clear of it.
TEST(Direction, TheFluteStaysOutOfTheOtherRing) {
  face_gear::FaceGearParameters g;
  g.teeth = 244;
  g.shaper_teeth = 38;
  g.module_mm = 1.25;
  g.module_plane = face_gear::ModulePlane::normal;
  g.pressure_angle_rad = radians(20);
  g.clearance_coefficient = 0.2;
  g.shaft_angle_rad = radians(100);
  g.shaper_tip_radius_mm = 0.3745;
  g.reference_radius_mm = 188.073;
  g.zones = {{radians(28.27), 186.017, 187.392}, {radians(-28.27), 188.754, 190.129}};
  const auto job =
      test::planned(g, {test::ball_mill(1.25, 3.985, 1.25, 10.548, 10)}, {test::roughing(0, 0.8, 0.6, 0.075)});
  for (const auto& d : job.plan.directions) {
    EXPECT_TRUE(d.fixed);
    EXPECT_EQ(d.lean_rad, 0);
    EXPECT_NE(d.explanation.find("other ring"), std::string::npos) << d.explanation;
  }
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  EXPECT_TRUE(check.passes(check.check(job.motions(), job.tool_of_operation())));
}

/// A tooth space of a small spur gear, and a ball mill whose holder is near.
struct SpaceOfASpur {
  static constexpr double kBall = 0.4;
  const face_gear::FaceGear gear = test::made(test::small_spur());
  const face_gear::FaceGearZone& zone = gear.rings().front().zone;
  tool::ToolAssembly tool = test::ball_mill(2 * kBall, 1.2, 2 * kBall, 1.5, 60);
  const analytic::GearDistance part{face_gear::part_of(gear), 10};
  const analytic::BodyTree tree{part};
  const tooth_space::OffsetSheet sheet{part.space(0), kBall, zone.inner_radius_mm, zone.outer_radius_mm, 17};

  [[nodiscard]] Vec3 at(double z) const {
    const double middle = 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm),
                 azimuth = 0.5 * kTwoPi / gear.parameters().teeth;  // space 0 lies between teeth 0 and 1
    return {middle * std::cos(azimuth), middle * std::sin(azimuth), z};
  }
  [[nodiscard]] Vec3 in_the_root() const { return at(gear.lowest_root() + kBall + 0.1); }
  [[nodiscard]] auto choose(const std::vector<ball::BallPass>& passes, const ball::DirectionOptions& options) const {
    return ball::choose_direction(part, tree, 0, sheet, passes, tool, options);
  }
};

// A thousand places above the teeth and one in the root, where the holder meets them in every direction: that one
// counts, wherever it stands among the others.
TEST(Direction, OnePlaceInTheWayCounts) {
  SpaceOfASpur space;
  std::vector<ball::BallPass> passes(1);
  for (int k = 0; k < 1001; ++k)
    passes[0].points.push_back({space.at(space.gear.blank_top() + 20), Vec3::Zero(), false});
  const auto choose = [&] { return space.choose(passes, {}); };
  ASSERT_TRUE(choose().fixed);
  for (const std::size_t among : {0U, 1U, 500U, 501U, 999U, 1000U}) {
    const auto kept = passes;
    passes[0].points[among].centre = space.in_the_root();
    EXPECT_FALSE(choose().fixed) << among;
    passes = kept;
  }
}

// Words and proof take a little of every gap: a direction that has no room for them is not taken.
TEST(Direction, RoomForTheWordsIsKeptBeyondTheClearance) {
  SpaceOfASpur space;
  std::vector<ball::BallPass> passes(1);
  passes[0].points.push_back({space.in_the_root(), Vec3::Zero(), false});
  const auto choose = [&](double clearance, double room) {
    ball::DirectionOptions options;
    options.clearance_mm = clearance;
    options.room_mm = room;
    return space.choose(passes, options);
  };
  const auto upright = [&](double clearance, double room) {
    const auto choice = choose(clearance, room);
    return choice.fixed && choice.lean_rad == 0;
  };
  while (space.tool.stick_out_mm < 30 && !upright(0.05, 0)) space.tool.stick_out_mm += 0.5;
  double least = 0.05, most = 2;
  ASSERT_TRUE(upright(least, 0));
  ASSERT_FALSE(upright(most, 0));
  while (most - least > 1e-4) (upright(0.5 * (least + most), 0) ? least : most) = 0.5 * (least + most);
  EXPECT_FALSE(upright(least, 1e-3));
  EXPECT_TRUE(upright(least - 2e-3, 1e-3));
}

TEST(Body, GapAgainstSampledSurfaces) {
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const double m = gear.parameters().module_mm;
    const analytic::GearDistance part(face_gear::part_of(gear), m);
    const analytic::BodyTree tree(part);
    const test::BruteForceGearSolid brute(gear);
    std::vector<Vec3> samples;
    for (int zone = 0; zone < part.zones(); ++zone)
      for (int patch = 0; patch < 6; ++patch)
        for (int i = 0; i <= 40; ++i)
          for (int j = 0; j <= 80; ++j) samples.push_back(brute.point(zone, patch, i / 40.0, j / 80.0));
    test::Random random(41);
    int close = 0;
    for (int k = 0; k < 60; ++k) {
      const double r = random(gear.inner_radius(), gear.outer_radius()),
                   a = part.space_azimuth(0, r) + random(-0.5, 0.5) * gear.pitch();
      const tool::Frustum f{random(0.2, 1) * m, random(2, 6) * m, random(0.1, 0.5) * m, random(0.1, 2) * m,
                            tool::Body::shank};
      const double lean = random(0, 0.5), to = random(0, 6.28);
      const Vec3 axis(std::sin(lean) * std::cos(to), std::sin(lean) * std::sin(to), std::cos(lean));
      const Vec3 tip(r * std::cos(a), r * std::sin(a), random(gear.lowest_root(), gear.blank_top() + 0.3 * m));
      double truth = INFINITY;
      for (int tooth = -3; tooth <= 3; ++tooth) {
        const Vec3 t = turned(tip, -tooth * gear.pitch()), u = turned(axis, -tooth * gear.pitch());
        for (const auto& p : samples) truth = std::min(truth, test::distance_to_frustum(p, f, t, u));
      }
      const double enough = 0.6 * m;
      const double gap = tree.gap(f, tip, axis, enough, 0.01);
      close += truth < enough;
      // Never above the sampled distance; below it by no more than resolution, sag and the step of the samples.
      EXPECT_LE(gap, std::min(truth, enough) + 1e-9) << name << " " << k;
      if (gap < enough && lowest_z(f, tip, axis) <= gear.blank_top()) {
        EXPECT_GE(gap, std::min(truth, enough) - 0.01 - 2 * part.cell_sag_mm() - 0.05) << name << " " << k;
      }
    }
    EXPECT_GE(close, 10) << name;
  }
}

TEST(Body, DistanceToAFrustumAgainstItsSampledSurface) {
  test::Random random(43);
  const tool::Frustum f{1, 4, 0.5, 1.5, tool::Body::holder};
  const Vec3 tip(1, 2, 3), axis = Vec3(0.2, -0.3, 0.9).normalized();
  const Vec3 side = axis.cross(Vec3::UnitX()).normalized(), other = axis.cross(side);
  std::vector<Vec3> surface;
  for (int k = 0; k < 400; ++k)
    for (int j = 0; j <= 60; ++j) {
      const double a = 2 * kPi * k / 400, t = j / 60.0;
      const Vec3 around = std::cos(a) * side + std::sin(a) * other;
      surface.push_back(tip + axis * (f.from + t * (f.to - f.from)) +
                        around * (f.radius_from + t * (f.radius_to - f.radius_from)));
      surface.push_back(tip + axis * f.from + around * t * f.radius_from);
      surface.push_back(tip + axis * f.to + around * t * f.radius_to);
    }
  for (int k = 0; k < 100; ++k) {
    const Vec3 p = tip + 3 * axis + Vec3(random(-4, 4), random(-4, 4), random(-4, 4));
    const double d = test::distance_to_frustum(p, f, tip, axis);
    if (d == 0) continue;
    double truth = INFINITY;
    for (const auto& q : surface) truth = std::min(truth, (q - p).norm());
    EXPECT_LE(d, truth + 1e-12);
    EXPECT_GE(d, truth - 0.03 * 0.03 / d - 2e-3);
  }
}

}  // namespace
}  // namespace toothpath
