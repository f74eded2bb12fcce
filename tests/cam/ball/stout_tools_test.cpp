// Stout tools: planned where they fit, kept away from the pole, cut in more strokes than one where the clear directions
// do not join, and refused with the body, the place, the gap and what would help.
#include <array>

#include "cam/ball/orientation_way.h"
#include "cam/ball/tool_orientation.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/plain_way.h"
#include "tests/cam/ball/stout_jobs.h"
#include "tests/support/face_part.h"
#include "tests/support/plain_frustum.h"

namespace toothpath {
namespace {

bool says(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

// Quick ones of the fourteen (toothpath_stout_bench plans all). Of the first three two used to be refused for a
// rounding, or to come to 0 to 1.8 deg of the gear axis in a hop; the clear directions of the last two are too narrow
// for a grid of 1 deg, and those of the last meet within 0.05 mm of the pass.
TEST(StoutTools, JobsArePlannedWhereTheyFit) {
  const auto jobs = test::stout_jobs();
  for (const std::size_t number : {5, 6, 9, 2, 10}) {
    const auto outcome = test::plan_stout(jobs[number - 1]);
    SCOPED_TRACE(fmt::format("{}: {}", number, outcome.words));
    EXPECT_FALSE(outcome.fixed);
    EXPECT_TRUE(outcome.proven);
    EXPECT_GE(outcome.least_tilt_rad, radians(2));
  }
}

/// Places of the passes at this radius and height: both flanks may have one.
std::vector<ball::BallPass::Point> places_at(const std::vector<ball::BallPass>& passes, double r, double z) {
  std::vector<ball::BallPass::Point> out;
  for (const auto& pass : passes) {
    const ball::PassTrack track(pass);
    ball::BallPass::Point nearest;
    double off = 0.005;
    for (double s = 0; s <= track.at().back(); s += 0.002) {
      const auto here = track.point(s);
      const double far = std::hypot(std::hypot(here.centre.x(), here.centre.y()) - r, here.centre.z() - z);
      if (far < off) off = far, nearest = here;
    }
    if (off < 0.005) out.push_back(nearest);
  }
  return out;
}

/// Of the directions within 60 deg, 0.7 deg apart, in which the ball cuts: those in which no body is found in the way.
int free_directions(const analytic::GearDistance& part, const tool::ToolAssembly& tool,
                    const ball::BallPass::Point& point, int& looked) {
  constexpr double kStep = 0.012;
  const auto frame = ball::pitch_frame(part, 0);
  const Vec3 normal = (point.centre - point.contact).normalized();
  int free = 0;
  looked = 0;
  for (double out = -1.74; out <= 1.74 && free == 0; out += kStep)
    for (double aside = -1.74; aside <= 1.74; aside += kStep) {
      const Vec3 axis = frame.axis(out, aside);
      if (out * out + aside * aside > 3 || normal.dot(axis) < 0.02) continue;
      ++looked;
      bool blocked = test::flute_is_in_the_way(part, tool, point.centre, axis);
      for (const auto& f : tool::shank_and_holder(tool))
        blocked = blocked || test::body_is_in_the_way(part, f, point.centre - tool.radius_mm() * axis, axis, 0.05);
      free += !blocked;
    }
  return free;
}

// The others are refused, and rightly: at the place that is told every direction within 60 deg brings shank or holder
// into the solid, or nearer to it than the clearance, or lets the flute cut. The body is named, and what would do does:
// planned and proven.
TEST(StoutTools, TheOthersAreToldWhyAndWhatWouldDo) {
  const auto jobs = test::stout_jobs();
  for (const std::size_t number : {1, 3, 4, 11, 13}) {
    auto job = jobs[number - 1];
    const auto words = test::plan_stout(job).words;
    SCOPED_TRACE(fmt::format("{}: {}", number, words));
    EXPECT_TRUE(says(words, "its shank cuts in by") || says(words, "its holder cuts in by"));
    EXPECT_TRUE(says(words, "it must keep 0.062 mm (the clearance is 0.050 mm"));
    const face_gear::FaceGear gear = test::made(test::stout_gear(job.gear));
    const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({job.tool}));
    bool one_is_blocked = false;
    for (const auto& point :
         places_at(test::stout_passes(job, part), test::number_after(words, "with the ball at radius "),
                   test::number_after(words, ", height "))) {
      int looked = 0;
      one_is_blocked = one_is_blocked || (free_directions(part, job.tool, point, looked) == 0 && looked > 20000);
    }
    EXPECT_TRUE(one_is_blocked);
    if (number != 3 && number != 4) continue;  // the quick ones; the bench tries all
    const auto advised = test::advised_tools(job, words);
    EXPECT_EQ(advised.size(), 2u);
    for (const auto& fitting : advised) {
      job.tool = fitting;
      const auto then = test::plan_stout(job);
      EXPECT_TRUE(then.proven) << then.words;
    }
  }
}

// Every place of the core is in the turned body, every place of the turned body in the hull.
TEST(StoutTools, TurnedBodiesLieBetweenCoreAndHull) {
  test::Random random(8);
  int cores = 0;
  for (int k = 0; k < 3000; ++k) {
    const double from = random(0.5, 8), pivot = random(0.2, 2), angle = std::pow(10, random(-3, -0.4));
    const tool::Frustum body{from, from + random(0.5, 40), random(0.5, 20), random(0.5, 20), tool::Body::holder};
    const double turn = angle * random(0.5, 1), to = random(0, 6.28);
    const Vec3 axis(std::sin(turn) * std::cos(to), std::sin(turn) * std::sin(to), std::cos(turn)),
        tip = pivot * (Vec3::UnitZ() - axis);
    const auto place = [&](const tool::Frustum& f, const Vec3& foot, const Vec3& up) -> Vec3 {
      const double share = random(0, 1), rho = f.radius_from + share * (f.radius_to - f.radius_from),
                   a = random(0, 6.28);
      const Vec3 x = up.unitOrthogonal(), y = up.cross(x);
      return foot + (f.from + share * (f.to - f.from)) * up + rho * (std::cos(a) * x + std::sin(a) * y);
    };
    const auto core = tool::turned_core(body, pivot, angle);
    const auto hull = tool::turned_hull(body, pivot, angle);
    cores += core.has_value();
    for (int n = 0; n < 20; ++n) {
      if (core) {
        ASSERT_LE(test::distance_to_frustum(place(*core, Vec3::Zero(), Vec3::UnitZ()), body, tip, axis), 1e-12);
      }
      ASSERT_LE(test::distance_to_frustum(place(body, tip, axis), hull, Vec3::Zero(), Vec3::UnitZ()), 1e-12);
    }
  }
  EXPECT_GT(cores, 1500);
}

// What is said of a square of leans holds for every lean of it.
TEST(StoutTools, SquaresOfLeansAreToldRightly) {
  const auto job = test::stout_jobs()[1];
  const face_gear::FaceGear gear = test::made(test::stout_gear(job.gear));
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({job.tool}));
  const analytic::BodyTree tree(part);
  const ball::OrientationOptions options;
  const ball::OrientationCheck check(part, tree, 0, job.tool, options);
  const auto passes = test::stout_passes(job, part);
  test::Random random(3);
  std::array<int, 3> told{};
  for (int k = 0; k < 9000; ++k) {
    const auto& points = passes[random.index(passes.size())].points;
    const auto& point = points[random.index(points.size())];
    const Vec2 q(random(-1, 1), random(-1, 1));
    const double half = std::pow(10, random(-2.5, -0.7));
    const auto leans = check.about(point, check.frame().axis(q.x(), q.y()), half * std::sqrt(2.0), 0.062, 0.002);
    ++told[std::size_t(leans)];
    for (int n = 0; n < 20 && leans != ball::Leans::mixed; ++n) {
      const Vec3 axis = check.frame().axis(q.x() + half * random(-1, 1), q.y() + half * random(-1, 1));
      // Resolution and sag of the tree's answers: 6 um.
      if (leans == ball::Leans::none_clear) {
        ASSERT_FALSE(check.clear(point, axis, 0.062, 0.002));
      } else {
        ASSERT_TRUE(check.clear(point, axis, 0.056, 0.002));
      }
    }
  }
  EXPECT_GT(told[std::size_t(ball::Leans::none_clear)], 500);
  EXPECT_GT(told[std::size_t(ball::Leans::all_clear)], 50);
}

// A way through leans that only a fine grid meets, by squares and one by one: the same. And one that comes together
// between two stations is found where these are set closer there.
TEST(StoutTools, SquaresFindTheWayThatSingleLeansFind) {
  const ball::LeanGrid grid(0.5, 0.01);
  const auto upright = [](std::size_t) { return Vec2(0, 0); };
  const auto always = [](std::size_t, const Vec2&, const Vec2&) { return true; };
  const auto middle = [](std::size_t k) { return Vec2(0.2 - 0.02 * double(k), 0.1); };
  const auto clear = [&](std::size_t k, const Vec2& q) { return (q - middle(k)).lpNorm<Eigen::Infinity>() < 0.011; };
  const auto square = [&](std::size_t k, const Vec2& centre, double half) {
    const double off = (centre - middle(k)).lpNorm<Eigen::Infinity>();
    return off - half >= 0.011  ? ball::Leans::none_clear
           : off + half < 0.011 ? ball::Leans::all_clear
                                : ball::Leans::mixed;
  };
  auto one = test::plain_way(12, 0.7), other = one;
  ASSERT_TRUE(ball::find_way(one, grid, upright, clear, always).found);
  ASSERT_TRUE(ball::find_way(other, grid, upright, clear, always, square).found);
  EXPECT_EQ(one.lean, other.lean);
  // Inwards up to 3.6 mm, outwards from 3.4 mm on: no station has both, one between them does.
  auto way = test::plain_way(12, 0.7);
  const auto parted = [&](std::size_t k, const Vec2& q) {
    return (way.s[k] <= 3.6 && q.x() <= -0.3) || (way.s[k] >= 3.4 && q.x() >= 0.3);
  };
  way.s[5] = 3.3;
  std::size_t blocked_at = 0;
  EXPECT_TRUE(ball::find_strokes(way, grid, upright, parted, always, blocked_at).empty());
  EXPECT_EQ(blocked_at, 6u);
  way.s.insert(way.s.begin() + 6, 3.5);
  way.r.insert(way.r.begin() + 6, 103.5);
  way.points.emplace_back();
  way.lean.emplace_back(0, 0);
  const auto strokes = ball::find_strokes(way, grid, upright, parted, always, blocked_at);
  ASSERT_EQ(strokes.size(), 2u);
  EXPECT_EQ(strokes[0].to, 6u);
  EXPECT_EQ(strokes[1].from, 6u);
}

// Whatever clearance is asked: a body with room all around keeps it.
TEST(StoutTools, ABodyWithRoomKeepsEveryClearance) {
  test::Random random(3);
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const analytic::GearDistance part(face_gear::part_of(gear), 1);
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
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({job.tool}));
  const auto plan = plan::plan_milling(part, {job.tool}, {test::finishing(0, job.scallop_mm, 0.002)}, {});
  ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
  const auto& told = plan.value().operations.front();
  EXPECT_GT(plan.value().directions.front().passes, told.passes) << "none was split";
  // Every place of the surface is as near to a ball as the asked cusp.
  const auto& records = plan.value().paths.front().records;
  const double R = job.tool.radius_mm();
  const auto& zone = test::sheet_of(part.space(0)).ring().zone;
  const tooth_space::OffsetSheet surface(part.space(0), 0, zone.inner_radius_mm, zone.outer_radius_mm, 17);
  for (int j = 0; j <= 24; ++j)
    for (int k = 0; k <= 120; ++k) {
      const auto at =
          surface.raw(5.0 * k / 120, zone.inner_radius_mm + (zone.outer_radius_mm - zone.inner_radius_mm) * j / 24);
      if (!at || at->contact.p.z() > test::sheet_of(part.space(0)).surface().z_tip(zone.inner_radius_mm)) continue;
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
