// Stout tools: planned where they fit, kept away from the pole, cut in more strokes than one where the clear directions
// do not join, and refused with the body, the place, the gap and what would help.
#include "cam/ball/orientation_way.h"
#include "cam/ball/tool_orientation.h"
#include "tests/cam/ball/plain_way.h"
#include "tests/cam/ball/stout_jobs.h"

namespace toothpath {
namespace {

bool says(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

// The quick ones of the fourteen (toothpath_stout_bench plans all). Two of the first three used to be refused for a
// rounding, or to come to 0 to 1.8 deg of the gear axis in a hop.
TEST(StoutTools, JobsArePlannedAndTheOthersToldWhy) {
  int proven = 0;
  const auto jobs = test::stout_jobs();
  for (const std::size_t number : {5, 6, 9, 3, 4, 13}) {
    const auto outcome = test::plan_stout(jobs[number - 1]);
    SCOPED_TRACE(fmt::format("{}: {}", number, outcome.words));
    EXPECT_FALSE(outcome.fixed);
    EXPECT_EQ(outcome.planned, outcome.proven);
    if (outcome.planned) {
      EXPECT_GE(outcome.least_tilt_rad, radians(2));
      ++proven;
      continue;
    }
    EXPECT_TRUE(says(outcome.words, "shank") || says(outcome.words, "holder") || says(outcome.words, "flute"));
    EXPECT_TRUE(says(outcome.words, "no five-axis motion either: with the ball at radius"));
    EXPECT_TRUE(says(outcome.words, "it must keep 0.062 mm"));
    EXPECT_TRUE(says(outcome.words, "would clear this place") || says(outcome.words, "would help") ||
                says(outcome.words, "is needed"));
    EXPECT_FALSE(says(outcome.words, "its  ")) << "a body without a name";
  }
  EXPECT_EQ(proven, 3);
}

// Whatever clearance is asked: a body with room all around keeps it.
TEST(StoutTools, ABodyWithRoomKeepsEveryClearance) {
  test::Random random(3);
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const analytic::GearDistance part(gear, 1);
    const analytic::BodyTree tree(part);
    const double r = 0.5 * (gear.inner_radius() + gear.outer_radius()), a = part.space_azimuth(0, r),
                 m = gear.parameters().module_mm, z = gear.blank_top() - 0.3 * m;
    const tool::Frustum thin{0, 0.2 * m, 0.02 * m, 0.02 * m, tool::Body::shank};
    const Vec3 tip(r * std::cos(a), r * std::sin(a), z);
    const double truth = tree.gap(thin, tip, Vec3::UnitZ(), m, 1e-4);
    ASSERT_GT(truth, 0.1 * m) << name;
    for (int k = 0; k < 500; ++k) {
      const double clearance = random(0.001, 0.09) * m;
      EXPECT_TRUE(tree.keeps(thin, tip, Vec3::UnitZ(), clearance, 0.01)) << name << " " << clearance;
      EXPECT_EQ(tree.gap(thin, tip, Vec3::UnitZ(), clearance, 0.01), clearance) << name;
    }
  }
}

// Inwards up to station 6, outwards from station 5 on, nothing between: two strokes, and both go over the stations that
// have both. With one such station they meet there; with none there are no strokes.
TEST(StoutTools, DirectionsThatDoNotJoinAreTwoStrokes) {
  const ball::LeanGrid grid(0.5);
  const auto way = test::plain_way(12, 0.7);
  const auto upright = [](std::size_t) { return Vec2(0, 0); };
  const auto always = [](std::size_t, const Vec2&, const Vec2&) { return true; };
  for (const std::size_t inwards_to : {6, 5, 4}) {
    const auto clear = [&](std::size_t k, const Vec2& q) {
      return (k <= inwards_to && q.x() <= -0.3) || (k >= 5 && q.x() >= 0.3);
    };
    auto whole = way;
    EXPECT_FALSE(ball::find_way(whole, grid, upright, clear, always).found);
    std::size_t blocked_at = 0;
    const auto strokes = ball::find_strokes(way, grid, upright, clear, always, blocked_at);
    if (inwards_to == 4) {
      EXPECT_TRUE(strokes.empty());
      EXPECT_EQ(blocked_at, 5u);
      continue;
    }
    ASSERT_EQ(strokes.size(), 2u);
    EXPECT_EQ(strokes[0].from, 0u);
    EXPECT_EQ(strokes[0].to, inwards_to);
    EXPECT_EQ(strokes[1].from, 5u);
    EXPECT_EQ(strokes[1].to, 11u);
    for (const auto& stroke : strokes) {
      ASSERT_EQ(stroke.lean.size(), stroke.to - stroke.from + 1);
      for (std::size_t k = stroke.from; k <= stroke.to; ++k) EXPECT_TRUE(clear(k, stroke.lean[k - stroke.from]));
    }
  }
}

// Planned with strokes, the job leaves no place of the surface higher than the cusp that was asked for.
TEST(StoutTools, APassInStrokesIsCutWhole) {
  const face_gear::FaceGear gear = test::made(test::stout_gear("axis"));
  const auto job = test::stout_jobs()[11];
  const analytic::GearDistance part(gear, ball::reach_of({job.tool}));
  const auto plan = plan::plan_face_gear(part, {job.tool}, {test::finishing(0, job.scallop_mm, 0.002)}, {});
  ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
  const auto& told = plan.value().operations.front();
  EXPECT_GT(plan.value().directions.front().passes, told.passes) << "none was split";
  // Every place of the surface is as near to a ball as the asked cusp.
  const auto& records = plan.value().paths.front().records;
  const double R = job.tool.radius_mm();
  const auto& zone = part.space(0).ring().zone;
  const face_gear::OffsetSheet surface(part.space(0), 0, zone.inner_radius_mm, zone.outer_radius_mm, 17);
  for (int j = 0; j <= 24; ++j)
    for (int k = 0; k <= 120; ++k) {
      const auto at =
          surface.raw(5.0 * k / 120, zone.inner_radius_mm + (zone.outer_radius_mm - zone.inner_radius_mm) * j / 24);
      if (!at || at->contact.p.z() > part.space(0).surface().z_tip(zone.inner_radius_mm)) continue;
      double least = INFINITY;
      for (std::size_t n = 1; n < records.size(); ++n) {
        if (records[n].kind != path::MoveKind::feed) continue;
        const Vec3 a = records[n - 1].tip + R * records[n - 1].axis, way = records[n].tip + R * records[n].axis - a;
        const double t = std::clamp((at->contact.p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (at->contact.p - a - t * way).norm());
      }
      EXPECT_LE(least - R, job.scallop_mm + 0.003) << j << " " << k;
    }
}

}  // namespace
}  // namespace toothpath
