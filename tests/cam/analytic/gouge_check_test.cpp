// The gouge check of whole programs: clean ones pass and nothing between the samples is deeper than the bound, wrong
// ones are refused.
#include "cam/analytic/gouge_check.h"

#include "cam/analytic/body_sweep.h"
#include "tests/cam/analytic/gouge_case.h"
#include "tests/support/brute_force_gear_solid.h"

namespace toothpath::test {
namespace {

class Clean : public testing::TestWithParam<std::string> {};

TEST_P(Clean, PassesWithItsBoundAboveWhatWasMeasured) {
  const auto& job = job_named(GetParam());
  const analytic::GougeCheck checker(*job.part, job.tools, job.check_options());
  for (const auto& path : job.plan.paths) {
    const auto r = checker.check(analytic::GougeCheck::motions_of(path), job.tool_of_operation());
    EXPECT_TRUE(r.worst.empty());
    EXPECT_TRUE(checker.passes(r)) << path.operation << " measured " << r.measured_mm << " bound " << r.bound_mm
                                   << " clearance " << r.clearance_mm << " " << r.deepest.patch << " at "
                                   << r.deepest.radius_mm;
    EXPECT_GE(r.bound_mm, r.measured_mm);
    EXPECT_LE(r.bound_mm, std::max(r.measured_mm, 0.0) + 2.5e-4);
    EXPECT_TRUE(r.rapids_clear);
    EXPECT_TRUE(checker.check_path(path));
    if (job.operations[std::size_t(path.operation)].allowance_mm == 0) {
      EXPECT_GE(r.measured_mm, -1e-6);  // it does touch
    }
  }
}

TEST_P(Clean, TenfoldSamplingStaysBelowTheBound) {
  const auto& job = job_named(GetParam());
  const BruteForceGearSolid brute(job.gear);
  Random random(31);
  for (const auto& path : job.plan.paths) {
    const auto motions = analytic::GougeCheck::motions_of(path);
    const auto r = check(job, motions);
    const double R = job.tool(path.operation).radius_mm();
    // Every move at ten places; a hundred places of them against the sampled surfaces themselves.
    EXPECT_LE(sampled(job, motions, R, 10).depth, r.bound_mm + 1e-9);
    for (int k = 0; k < 60; ++k) {
      const auto& m = motions[random.index(motions.size())];
      const double t = random(0, 1);
      const Vec3 c = (1 - t) * m.tip_from + t * m.tip_to + R * ((1 - t) * m.axis_from + t * m.axis_to).normalized();
      EXPECT_LE(R - brute.nearest(c).distance, r.bound_mm + 1e-7);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, Clean, testing::Values("dhfg", "offset", "conical", "spur"), [](const auto& job_case) {
  std::string name = job_case.param;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(WrongPrograms, ShiftedZone) {
  const auto& job = job_named("dhfg");
  auto path = job.plan.paths.back();
  for (auto& r : path.records)
    if (r.zone == 1) r.tip = turned(r.tip, 0.005 / 121);  // 5 um along the circle
  const auto r = check(job, analytic::GougeCheck::motions_of(path));
  EXPECT_FALSE(passes(job, r));
  EXPECT_EQ(r.deepest.zone, 1);
  EXPECT_GE(r.measured_mm, 0.002);
}

TEST(WrongPrograms, SwappedSign) {
  const auto& job = job_named("dhfg");
  for (int axis = 0; axis < 2; ++axis) {
    auto path = job.plan.paths.back();
    for (auto& r : path.records) r.tip[axis] = -r.tip[axis];
    EXPECT_FALSE(passes(job, check(job, analytic::GougeCheck::motions_of(path)))) << axis;
  }
}

TEST(WrongPrograms, WrongBallRadius) {
  const auto& job = job_named("spur");
  auto tools = job.tools;
  tools[0].diameter_mm += 0.01;
  const auto r = check(job, analytic::GougeCheck::motions_of(job.plan.paths.back()), tools);
  EXPECT_FALSE(passes(job, r));
  // The tip stays: the ball grows by 5 um and rises by 5 um, which leaves 5 (1 - n.axis) um on a flank.
  EXPECT_GE(r.measured_mm, 0.005 * (1 - std::sin(radians(20))));
}

TEST(WrongPrograms, WrongToolLength) {
  const auto& job = job_named("offset");
  auto path = job.plan.paths.back();
  for (auto& r : path.records) r.tip -= 0.005 * r.axis;
  const auto r = check(job, analytic::GougeCheck::motions_of(path));
  EXPECT_FALSE(passes(job, r));
  EXPECT_NEAR(r.measured_mm, 0.005, 5e-4);  // on the root land the whole of it
}

TEST(WrongPrograms, OneToothOnly) {
  const auto& job = job_named("spur");
  auto motions = analytic::GougeCheck::motions_of(job.plan.paths.back());
  const double pitch = job.gear.pitch();
  for (auto& m : motions) {
    m.tooth = 17;
    m.tip_from = turned(m.tip_from, 17 * pitch);
    m.tip_to = turned(m.tip_to, 17 * pitch);
  }
  EXPECT_TRUE(passes(job, check(job, motions)));
  for (auto& m : motions) {
    m.tip_from = turned(m.tip_from, 0.005 / 62);
    m.tip_to = turned(m.tip_to, 0.005 / 62);
  }
  const auto r = check(job, motions);
  EXPECT_FALSE(passes(job, r));
  ASSERT_FALSE(r.worst.empty());
  EXPECT_EQ(r.worst.front().tooth, 17);
}

/// How far the ball stays from the full cylinder of the blank along a motion; looked at densely.
double ball_from_blank(const PlannedJob& job, const path::ToolMotion& m) {
  double least = INFINITY;
  for (int k = 0; k <= 2000; ++k) {
    const double R = job.tools[0].radius_mm(), t = k / 2000.0;
    const Vec3 centre = path::tip_at(m, t) + R * path::axis_at(m, t);
    least = std::min(least, std::hypot(std::max(0.0, radius(centre) - job.gear.outer_radius()),
                                       std::max(0.0, centre.z() - job.gear.blank_top())) -
                                R);
  }
  return least;
}

TEST(WrongPrograms, RapidThroughTheBlank) {
  for (const char* name : {"dhfg", "spur", "conical"}) {
    const auto& job = job_named(name);
    const auto& path = job.plan.paths.front();
    // Back from the last place to the first one, at the clearance height: allowed. Lower, it meets the blank.
    path::ToolMotion rapid;
    rapid.rapid = true;
    rapid.tip_from = path.records.back().tip;
    rapid.tip_to = path.records.front().tip;
    rapid.axis_from = path.records.back().axis;
    rapid.axis_to = path.records.front().axis;
    EXPECT_TRUE(check(job, {rapid}).rapids_clear) << name;
    for (const bool first : {true, false}) {
      auto low = rapid;
      Vec3& end = first ? low.tip_from : low.tip_to;
      end.z() = job.gear.blank_top() - 0.02;
      while (ball_from_blank(job, low) > -0.01) end.z() -= 0.02;  // a tool that leans outwards passes it at first
      const auto r = check(job, {low});
      EXPECT_FALSE(r.rapids_clear) << name;
      EXPECT_FALSE(passes(job, r));
    }
  }
}

/// A shank beside an end of the ring: free, closer than is asked for, and in it, at rest but for a little or on a long
/// way. Ends that were halved on one side alone took 800 000 pieces.
TEST(WrongPrograms, AShankBesideAnEndIsJudgedInFewPieces) {
  const auto& job = job_named("spur");
  const tool::Frustum shank{6, 16, 0.475, 0.475, tool::Body::shank};
  analytic::SweptGapOptions look;
  look.contact_mm = 0.005;
  look.asked_mm = 0.05;
  Random random(59);
  std::size_t most = 0;
  for (int k = 0; k < 120; ++k) {
    const double gap = k % 6 == 0 ? -0.015 : random(-0.2, 0.45), azimuth = random(0, job.gear.pitch());
    const double r = job.gear.inner_radius() - gap - 0.475;
    path::ToolMotion m;
    m.axis_from = m.axis_to = Vec3::UnitZ();
    m.tip_from = {r * std::cos(azimuth), r * std::sin(azimuth), job.gear.blank_top() - random(8, 22)};
    m.tip_to = m.tip_from + Vec3(random(-0.1, 0.1), random(-0.3, 0.3), k % 3 == 0 ? -random(0, 23) : random(-0.3, 0.3));
    const auto found = analytic::swept_gap(*job.part, shank, m, look);
    most = std::max(most, found.pieces);
    EXPECT_LE(found.pieces, 40000U) << k << ": gap " << gap;
    EXPECT_LE(found.proven_mm, found.measured_mm) << k;
    EXPECT_GE(found.proven_mm, -0.475) << k << ": no place lies deeper in a shank than its radius";
    EXPECT_TRUE(found.measured_mm <= 0.07 || found.proven_mm >= 0.05) << k << ": " << found.proven_mm;
  }
  RecordProperty("most_pieces", int(most));
}

/// A rapid through the blank is refused for that; nobody asks what else it does.
TEST(WrongPrograms, ARapidThroughTheBlankIsFollowedNoFarther) {
  const auto& job = job_named("spur");
  path::ToolMotion rapid;
  rapid.rapid = true;
  rapid.line = 17;
  rapid.axis_from = rapid.axis_to = Vec3::UnitZ();
  rapid.tip_from = {job.gear.inner_radius() + 1, 0, job.gear.blank_top() + 5};
  rapid.tip_to = rapid.tip_from - 90 * Vec3::UnitZ();
  const auto r = check(job, {rapid, rapid});
  EXPECT_FALSE(r.rapids_clear);
  EXPECT_FALSE(passes(job, r));
  EXPECT_EQ(r.motions, 2U);
  EXPECT_EQ(r.distance_queries, 0U);
  ASSERT_FALSE(r.worst.empty());
  EXPECT_EQ(r.worst.front().patch, "blank");
  EXPECT_EQ(r.worst.front().line, 17);
}

TEST(WrongPrograms, ShankAndHolder) {
  const auto& job = job_named("spur");
  const auto motions = analytic::GougeCheck::motions_of(job.plan.paths.back());
  auto fat = job.tools;
  fat[0].shank_diameter_mm = 2.4;
  fat[0].flute_length_mm = 2.0;
  auto r = check(job, motions, fat);
  EXPECT_FALSE(passes(job, r));
  ASSERT_FALSE(r.worst.empty());
  const auto worst_is = [&](const char* body) {
    return std::any_of(r.worst.begin(), r.worst.end(),
                       [&](const proof::WorstPlace& w) { return to_string(w.body) == body; });
  };
  EXPECT_TRUE(worst_is("shank"));
  auto stubby = job.tools;
  stubby[0].flute_length_mm = 3;
  stubby[0].stick_out_mm = 3.5;
  r = check(job, motions, stubby);
  EXPECT_FALSE(passes(job, r));
  EXPECT_TRUE(worst_is("holder"));
  const analytic::GougeCheck checker(*job.part, stubby, job.check_options());
  const auto refused = checker.check_path(job.plan.paths.back());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("holder"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace toothpath::test
