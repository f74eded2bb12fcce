// Simultaneous five-axis: clear directions against sampled surfaces, the search against enumeration, a job that needs
// it, jobs that do not.
#include "cam/ball/tool_orientation.h"

#include <set>
#include <string>

#include "cam/ball/orientation_way.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/cam/ball/plain_way.h"
#include "tests/support/brute_force_gear_solid.h"
#include "tests/support/plain_frustum.h"

namespace toothpath {
namespace {

face_gear::FaceGearParameters steep_gear() { return test::steep_gear(105, 77.5, 85.5); }

tool::ToolAssembly short_tool(double stick_out = 12.0) {
  auto t = test::ball_mill(2, 6, 7.6, stick_out, 40);
  t.holder = {{40, 40, 40}};
  return t;
}

const test::PlannedJob& short_job() {
  static const test::PlannedJob job = test::planned(steep_gear(), {short_tool()}, {test::finishing(0, 0.15, 0.002)});
  return job;
}

std::string refusal_with(const tool::ToolAssembly& tool) {
  const face_gear::FaceGear gear = test::made(steep_gear());
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.5, 0.002)}, {});
  const auto* refusal = plan.refused();
  return refusal != nullptr ? refusal->key + ": " + refusal->diagnostic.message : "";
}

// Dense points of all patches of space 0, and of the end faces below them.
std::vector<Vec3> sampled(const face_gear::FaceGear& gear) {
  const test::BruteForceGearSolid brute(gear);
  std::vector<Vec3> samples;
  for (int patch = 0; patch < 6; ++patch)
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 60; ++j) {
        const Vec3 p = brute.point(0, patch, i / 40.0, j / 60.0);
        samples.push_back(p);
        if (j == 0 || j == 60)
          for (double down = 0.25; p.z() - down > gear.lowest_root(); down += 0.25)
            samples.emplace_back(p.x(), p.y(), p.z() - down);
      }
  return samples;
}

double sampled_gap(const std::vector<Vec3>& samples, double pitch, const tool::Frustum& f, const Vec3& tip,
                   const Vec3& axis) {
  double truth = INFINITY;
  for (int tooth = -2; tooth <= 2; ++tooth) {
    const Vec3 t = turned(tip, -tooth * pitch), u = turned(axis, -tooth * pitch);
    for (const auto& p : samples) truth = std::min(truth, test::distance_to_frustum(p, f, t, u));
  }
  return truth;
}

/// Every facet of the teeth about space 0, one after another.
double flat_gap(const analytic::GearDistance& part, const tool::Frustum& f, const Vec3& tip, const Vec3& axis,
                double enough, double resolution) {
  const double above = tool::lowest_z(f, tip, axis) - part.part().blank_top(), sag = part.cell_sag_mm();
  if (above >= enough) return enough;
  double best = enough + sag;
  for (int zone = 0; zone < part.zones(); ++zone)
    for (int tooth = -4; tooth <= 4; ++tooth) {
      const Vec3 t = turned(tip, -tooth * part.part().pitch()), u = turned(axis, -tooth * part.part().pitch());
      for (const auto& [a, b, c] : part.triangles(zone))
        best = test::triangle_gap(a, b, c, f, t, u, best, resolution, 8);
    }
  return std::max(best - sag, above);
}

TEST(BodyTree, AgreesWithTheFlatSearchAndWithSamples) {
  for (const auto& name : test::gear_names()) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const double m = gear.parameters().module_mm, enough = 0.6 * m;
    const analytic::GearDistance part(face_gear::part_of(gear), m);
    const analytic::BodyTree tree(part);
    test::Random random(71);
    int close = 0;
    for (int k = 0; k < 100; ++k) {
      const double r = random(gear.inner_radius(), gear.outer_radius()),
                   a = part.space_azimuth(0, r) + random(-0.5, 0.5) * gear.pitch();
      const tool::Frustum f{random(0.2, 1) * m, random(2, 6) * m, random(0.1, 0.5) * m, random(0.1, 2) * m,
                            tool::Body::shank};
      const double lean = random(0, 0.6), to = random(0, 6.28);
      const Vec3 axis(std::sin(lean) * std::cos(to), std::sin(lean) * std::sin(to), std::cos(lean));
      const Vec3 tip(r * std::cos(a), r * std::sin(a), random(gear.lowest_root(), gear.blank_top() + 0.3 * m));
      const double flat = flat_gap(part, f, tip, axis, enough, 0.01), ours = tree.gap(f, tip, axis, enough, 0.01);
      close += flat < enough;
      if (flat < 0) {
        EXPECT_EQ(ours, -0.01) << name << " " << k;
      } else {
        EXPECT_NEAR(ours, flat, 1e-9) << name << " " << k;
      }
      // One yes or no, which may end early, is the same answer.
      for (const double clearance : {0.05, flat - 1e-6, flat + 1e-6}) {
        if (clearance < 0 || clearance > enough) continue;
        EXPECT_EQ(tree.keeps(f, tip, axis, clearance, 0.01), flat >= clearance) << name << " " << k;
      }
    }
    EXPECT_GE(close, 20) << name;
  }
}

// A direction that is called clear keeps its gap from every sampled point; one that is not has a point within it.
TEST(Orientation, ClearDirectionsAgainstSampledSurfaces) {
  const auto& job = short_job();
  const analytic::BodyTree tree(*job.part);
  const ball::OrientationOptions options;
  const ball::OrientationCheck check(*job.part, tree, 0, job.tools[0], options);
  const auto samples = sampled(job.gear);
  const auto& records = job.plan.paths[0].records;
  test::Random random(5);
  int clear = 0, blocked = 0;
  while (clear + blocked < 60) {
    const auto& record = records[random.index(records.size())];
    if (record.kind != path::MoveKind::feed) continue;
    ball::BallPass::Point point;
    point.centre = point.contact = record.tip + job.tools[0].radius_mm() * record.axis;
    const Vec3 axis = check.frame().axis(random(-0.3, 0.3), random(-0.15, 0.15));
    double truth = INFINITY;
    for (const auto& f : check.bodies())
      truth = std::min(truth,
                       sampled_gap(samples, job.gear.pitch(), f, point.centre - job.tools[0].radius_mm() * axis, axis));
    if (check.clear(point, axis, 0.05)) {
      ++clear;
      EXPECT_GE(truth, 0.05);
    } else if (check.cutting(point, axis)) {
      ++blocked;
      // Resolution, sag, and the step of the samples.
      EXPECT_LE(truth, 0.05 + 0.01 + 2 * job.part->cell_sag_mm() + 0.05);
    }
  }
  EXPECT_GE(clear, 10);
  EXPECT_GE(blocked, 10);
}

// An edge between two heights that are asked is found, too: tips at the ends of the teeth are as sharp as any.
TEST(Orientation, AFluteThatIsFreeCutsNowhere) {
  const auto& job = short_job();
  const analytic::BodyTree tree(*job.part);
  const ball::OrientationOptions options;
  const ball::OrientationCheck check(*job.part, tree, 0, job.tools[0], options);
  const double R = job.tools[0].radius_mm(), top = job.tools[0].flute_length_mm - R;
  const auto& records = job.plan.paths[0].records;
  test::Random random(6);
  int free = 0, between = 0;
  for (int k = 0; k < 12000; ++k) {
    const auto& record = records[random.index(records.size())];
    ball::BallPass::Point point;
    point.centre = point.contact =
        record.tip + R * record.axis + Vec3(random(-1, 1), random(-1, 1), random(-0.2, 0.8)) * R;
    const double r = job.part->part().chart().along(point.centre);
    if (std::min(std::abs(r - job.gear.inner_radius()), std::abs(r - job.gear.outer_radius())) > R) continue;
    if (job.part->nearest(point.centre, R).distance < R) continue;
    const Vec3 axis = check.frame().axis(random(-0.6, 0.6), random(-0.6, 0.6));
    double deepest = 0, at_steps = 0;
    for (int h = 1; h <= 100; ++h) deepest = std::max(deepest, check.flute_cut(point, axis, top * h / 100));
    for (double h = 0.4 * R; h < top; h += R) at_steps = std::max(at_steps, check.flute_cut(point, axis, h));
    between += at_steps == 0 && deepest > 0.001;
    if (!check.cutting(point, axis)) continue;
    ++free;
    EXPECT_LE(deepest, 1.1e-4);
  }
  EXPECT_GE(free, 200);
  EXPECT_GE(between, 3);  // edges that stand between the heights asked first
}

double cost_of(const std::vector<Vec2>& leans, double ds, const ball::LeanReference& reference) {
  double cost = 0;
  for (std::size_t k = 0; k < leans.size(); ++k) {
    cost +=
        ds * (ball::kLeanWeight * leans[k].squaredNorm() + ball::kNearWeight * (leans[k] - reference(k)).squaredNorm());
    if (k > 0) cost += ball::kTurnWeight * (leans[k] - leans[k - 1]).squaredNorm() / ds;
  }
  return cost;
}

TEST(OrientationWay, CheapestOfAllWaysOnASmallGrid) {
  const ball::LeanGrid grid(0.085);
  ASSERT_EQ(grid.leans.size(), 13u);
  test::Random random(9);
  int compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    auto way = test::plain_way(4, 0.7);
    std::vector<char> open(4 * 13);
    for (auto& o : open) o = random(0, 1) < 0.3;
    const Vec2 aim(random(-0.1, 0.1), random(-0.1, 0.1));
    const auto reference = [&](std::size_t) { return aim; };
    const auto index = [&](const Vec2& q) {
      for (std::size_t g = 0; g < 13; ++g)
        if ((grid.leans[g] - q).norm() < 1e-9) return g;
      return std::size_t(13);
    };
    const auto clear = [&](std::size_t k, const Vec2& q) { return index(q) < 13 && open[13 * k + index(q)]; };
    const auto found =
        ball::find_way(way, grid, reference, clear, [](std::size_t, const Vec2&, const Vec2&) { return true; });
    double best = INFINITY;
    for (std::size_t n = 0; n < 13 * 13 * 13 * 13; ++n) {
      const std::size_t g[4] = {n % 13, n / 13 % 13, n / 169 % 13, n / 2197};
      bool good = true;
      for (std::size_t k = 0; k < 4 && good; ++k) good = open[13 * k + g[k]];
      if (good)
        best = std::min(
            best, cost_of({grid.leans[g[0]], grid.leans[g[1]], grid.leans[g[2]], grid.leans[g[3]]}, 0.7, reference));
    }
    ASSERT_EQ(found.found, best < INFINITY);
    if (!found.found) {
      EXPECT_TRUE(found.none_clear);
      continue;
    }
    ++compared;
    EXPECT_NEAR(cost_of(way.lean, 0.7, reference), best, 1e-12);
  }
  EXPECT_GE(compared, 20);
}

TEST(OrientationWay, OneLeanWhereOneIsClearAndAWallIsGoneAround) {
  const ball::LeanGrid grid(0.5);
  const auto upright = [](std::size_t) { return Vec2(0, 0); };
  auto way = test::plain_way(12, 0.7);
  ASSERT_TRUE(ball::find_constant(way, grid, upright, [](std::size_t, const Vec2& q) { return q.x() >= 0.1; }));
  EXPECT_TRUE(way.constant);
  for (const auto& q : way.lean) EXPECT_NEAR((q - Vec2(0.12, 0)).norm(), 0, 1e-12);
  // First inwards, then outwards: no constant lean; and half-way through station 5 upright is blocked.
  const auto clear = [](std::size_t k, const Vec2& q) { return k < 4 ? q.x() <= -0.1 : k > 7 ? q.x() >= 0.1 : true; };
  auto turning = test::plain_way(12, 0.7);
  ASSERT_FALSE(ball::find_constant(turning, grid, upright, clear));
  const auto half = [](std::size_t k, const Vec2& a, const Vec2& b) {
    return k != 5 || std::abs(0.5 * (a + b).y()) > 0.05;
  };
  ASSERT_TRUE(ball::find_way(turning, grid, upright, clear, half).found);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_TRUE(clear(k, turning.lean[k]));
    if (k > 0) { EXPECT_LE((turning.lean[k] - turning.lean[k - 1]).norm(), 0.25 * 0.7 + 1e-9); }
  }
  EXPECT_TRUE(half(5, turning.lean[5], turning.lean[6]));
  // The cubic passes through its stations, stays in their boxes and has no kink.
  for (std::size_t k = 1; k < 12; ++k)
    for (double t = 0; t <= 1; t += 0.05) {
      const double s = turning.s[k - 1] + t * 0.7;
      const Vec2 q = turning.lean_along(s, true);
      for (int i = 0; i < 2; ++i) {
        EXPECT_GE(q[i], std::min(turning.lean[k - 1][i], turning.lean[k][i]) - 1e-12);
        EXPECT_LE(q[i], std::max(turning.lean[k - 1][i], turning.lean[k][i]) + 1e-12);
      }
    }
  for (std::size_t k = 1; k + 1 < 12; ++k) {
    const double e = 1e-6, s = turning.s[k];
    const Vec2 left = (turning.lean_along(s, true) - turning.lean_along(s - e, true)) / e,
               right = (turning.lean_along(s + e, true) - turning.lean_along(s, true)) / e;
    EXPECT_NEAR((left - right).norm(), 0, 1e-4);
  }
}

TEST(Orientation, ShortToolNeedsItAndIsProven) {
  const auto& job = short_job();
  ASSERT_EQ(job.plan.directions.size(), 1u);
  const auto& d = job.plan.directions.front();
  EXPECT_FALSE(d.fixed);
  EXPECT_GE(d.candidates.size(), 200u);
  for (const auto& c : d.candidates) {
    EXPECT_FALSE(c.clear);
    EXPECT_NE(c.worst_body, tool::Body::none);
    EXPECT_LT(c.gap_mm, 0.05);
  }
  EXPECT_GE(d.turning_passes, 1);
  EXPECT_LT(d.turning_passes, d.passes);
  EXPECT_GE(d.clearance_mm, 0.05);
  EXPECT_LE(d.greatest_step_rad, ball::kMostTurnPerRecord);
  EXPECT_LE(d.greatest_turn_rad_per_mm, 0.1);
  EXPECT_NE(d.explanation.find("no fixed direction is clear"), std::string::npos);
  EXPECT_NE(d.explanation.find("so the axis turns"), std::string::npos);
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  const auto result = check.check(job.motions(), {0});
  EXPECT_TRUE(check.passes(result)) << result.bound_mm << " " << result.clearance_mm;
}

TEST(Orientation, AxisIsContinuousAndTheBallStaysOnItsPass) {
  const auto& job = short_job();
  const double R = job.tools[0].radius_mm();
  const auto& records = job.plan.paths[0].records;
  double most = 0;
  for (std::size_t k = 1; k < records.size(); ++k) {
    const auto &a = records[k - 1], &b = records[k];
    EXPECT_NEAR(b.axis.norm(), 1, 1e-12);
    const double turn = angle_between(a.axis, b.axis);
    if (b.kind == path::MoveKind::rapid) continue;
    EXPECT_LE(turn, ball::kMostTurnPerRecord) << k;
    if (turn == 0) continue;
    const Vec3 from = a.tip + R * a.axis, to = b.tip + R * b.axis;
    for (double t = 0.1; t < 1; t += 0.1) {
      const Vec3 axis = ((1 - t) * a.axis + t * b.axis).normalized(), centre = (1 - t) * a.tip + t * b.tip + R * axis;
      const double off = (centre - ((1 - t) * from + t * to)).norm();
      EXPECT_LE(off, ball::centre_sag(R, turn) * (1 + 1e-6) + 1e-12) << k;
      most = std::max(most, off);
    }
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 2e-4);
}

TEST(Orientation, APlantedCollisionIsFound) {
  const auto& job = short_job();
  const double R = job.tools[0].radius_mm();
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  // One direction of the path held throughout is refused somewhere, else a fixed one would have done.
  const auto& records = job.plan.paths[0].records;
  const Vec3 held = records[records.size() / 2].axis;
  path::ClPath fixed = job.plan.paths[0];
  for (auto& r : fixed.records) {
    r.tip += R * (r.axis - held);
    r.axis = held;
  }
  const auto passed = check.check_path(fixed);
  ASSERT_FALSE(passed);
  EXPECT_TRUE(passed.error().message.find("shank") != std::string::npos ||
              passed.error().message.find("holder") != std::string::npos)
      << passed.error().message;
  // One record in the deepest pass leans 8 deg too far to the side.
  std::size_t lowest = 0;
  for (std::size_t k = 1; k + 1 < records.size(); ++k)
    if (records[k].kind == path::MoveKind::feed && records[k + 1].kind == path::MoveKind::feed &&
        (records[lowest].kind != path::MoveKind::feed || records[k].tip.z() < records[lowest].tip.z()))
      lowest = k;
  path::ClPath path = job.plan.paths[0];
  auto& r = path.records[lowest];
  const Vec3 axis = Eigen::AngleAxisd(radians(8), Vec3(r.tip.x(), r.tip.y(), 0).normalized()) * r.axis;
  r.tip += R * (r.axis - axis);
  r.axis = axis;
  auto motions = analytic::GougeCheck::motions_of(path);
  std::erase_if(motions, [&](const path::ToolMotion& m) { return std::abs(m.line - int(lowest)) > 3; });
  const auto result = check.check(motions, {0});
  EXPECT_FALSE(check.passes(result));
  ASSERT_FALSE(result.worst.empty());
  EXPECT_NEAR(result.worst.front().line, double(lowest), 1.5);
}

TEST(Orientation, WhatCannotBeDoneIsRefusedWithThePlace) {
  const auto blocked = refusal_with(short_tool(7));
  EXPECT_EQ(blocked.substr(0, 18), "operation[0].tool:");
  EXPECT_NE(blocked.find("no fixed direction is clear"), std::string::npos) << blocked;
  EXPECT_NE(blocked.find("no five-axis motion either"), std::string::npos) << blocked;
  EXPECT_NE(blocked.find("radius"), std::string::npos) << blocked;
  EXPECT_NE(blocked.find("holder"), std::string::npos) << blocked;
  EXPECT_NE(blocked.find("the clearance is 0.050 mm"), std::string::npos) << blocked;
  const auto at = blocked.find("a stick-out of ");
  ASSERT_NE(at, std::string::npos) << blocked;
  const double advised = std::stod(blocked.substr(at + 15));
  EXPECT_GT(advised, 7);
  EXPECT_LE(advised, 12.0);  // with which the whole job is known to work
  EXPECT_EQ(refusal_with(short_tool(advised)), "") << "what is advised is planned";
}

// What is hardly enough costs many times what has room: trials pass it by.
TEST(Orientation, TrialsTakeAToolThatHasRoom) {
  const auto thick = [](double shank, double flute) {
    auto t = test::ball_mill(2, flute, shank, 12 + flute - 6, 40);
    t.holder = {{40, 40, 40}};
    return t;
  };
  const face_gear::FaceGear gear = test::made(steep_gear());
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({thick(11, 6)}));
  plan::Options trial;
  trial.trial = true;
  EXPECT_TRUE(plan::plan_milling(part, {thick(11, 7.4)}, {test::finishing(0, 0.5, 0.002)}, trial).refused());
  EXPECT_FALSE(plan::plan_milling(part, {thick(7.35, 6)}, {test::finishing(0, 0.5, 0.002)}, trial).refused());
}

TEST(Orientation, PlainJobsRunNoSimultaneousSolver) {
  const auto before = ball::orientation_runs();
  const face_gear::FaceGear gear = test::made(test::small_spur());
  const auto tool = test::ball_mill(1, 6, 0.95, 16, 10);
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  std::set<std::string> stages;
  plan::Options options;
  options.stage = [&](const std::string& name, const std::function<void()>& work) {
    stages.insert(name);
    work();
  };
  const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.05, 0.004)}, options);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(ball::orientation_runs(), before);
  EXPECT_EQ(stages, (std::set<std::string>{"tool passes", "tool direction", "links"}));
  const auto& planned = plan.value();
  EXPECT_TRUE(planned.directions.front().fixed);
  for (const auto& r : planned.paths.front().records) EXPECT_EQ(r.axis, planned.directions.front().axis);
}

}  // namespace
}  // namespace toothpath
