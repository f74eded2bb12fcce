// Teeth that are nearly the first one again are looked at only where what is proven of the first one, and the way
// between them, does not do: the proof finds the same, and planted cuts are found wherever they are.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "tests/cam/analytic/gouge_case.h"
#include "tests/support/random.h"
#include "tests/support/threads.h"

namespace toothpath {
namespace {

using test::job_named;
using test::PlannedJob;

constexpr double kRounded = 6e-4;  // mm: every coordinate of the tip of a copy, at most
constexpr double kLean = 2e-6;     // the same of its axis

/// The first tooth, and others whose blocks end a little beside.
struct Teeth {
  std::vector<path::ToolMotion> motions;
  std::vector<proof::LikeMotion> likes;
  std::size_t of_tooth = 0;  ///< motions
};

Teeth teeth_of(const PlannedJob& job, int copies) {
  Teeth out;
  for (const auto& m : job.motions())
    if (!m.rapid) out.motions.push_back(m);
  out.of_tooth = out.motions.size();
  test::Random random(14);
  for (int tooth = 1; tooth <= copies; ++tooth) {
    const double turn = tooth * job.gear.pitch();
    Vec3 tip = random.vector(kRounded), axis = random.vector(kLean);
    for (std::size_t k = 0; k < out.of_tooth; ++k) {
      path::ToolMotion m = out.motions[k];
      const Vec3 tip_then = random.vector(kRounded), axis_then = random.vector(kLean);
      m.tip_from = turned(m.tip_from + tip, turn);
      m.tip_to = turned(m.tip_to + tip_then, turn);
      m.axis_from = turned((m.axis_from + axis).normalized(), turn);
      m.axis_to = turned((m.axis_to + axis_then).normalized(), turn);
      m.tooth = tooth;
      m.line = int(out.motions.size());
      out.likes.push_back({std::uint32_t(out.motions.size()), std::uint32_t(k), std::uint32_t(k + 1),
                           float(std::max(tip.norm(), tip_then.norm()) * (1 + 1e-6)),
                           float(2 * std::max(axis.norm(), axis_then.norm()))});
      out.motions.push_back(m);
      tip = tip_then;
      axis = axis_then;
    }
  }
  return out;
}

/// By ball and flute, or with the same tool as one convex body.
analytic::GougeCheck checker(const PlannedJob& job, bool profile) {
  auto tools = tool::proof_tools(job.tools);
  if (profile)
    for (auto& tool : tools) tool.ball_mill.reset();
  return {*job.part, tools, job.check_options()};
}

void expect_the_list(const proof::GougeResult& a, const proof::GougeResult& b) {
  EXPECT_EQ(a.measured_mm, b.measured_mm);
  EXPECT_EQ(a.bound_mm, b.bound_mm);
  EXPECT_EQ(a.bound_line, b.bound_line);
  EXPECT_EQ(a.clearance_mm, b.clearance_mm);
  EXPECT_EQ(a.clearance_measured_mm, b.clearance_measured_mm);
  EXPECT_EQ(a.deepest.line, b.deepest.line);
  EXPECT_EQ(a.deepest.depth_mm, b.deepest.depth_mm);
  EXPECT_EQ(a.closest.line, b.closest.line);
  EXPECT_EQ(a.motions, b.motions);
  EXPECT_EQ(a.distance_queries, b.distance_queries);
  ASSERT_EQ(a.worst.size(), b.worst.size());
  for (std::size_t k = 0; k < a.worst.size(); ++k) EXPECT_EQ(a.worst[k].line, b.worst[k].line) << k;
}

class LikeTeeth : public testing::TestWithParam<bool> {};

TEST_P(LikeTeeth, TheSameIsProvenForLess) {
  const PlannedJob& job = job_named("spur");
  const Teeth teeth = teeth_of(job, 14);
  const auto check = checker(job, GetParam());
  const auto each = check.check(teeth.motions, job.tool_of_operation()),
             shared = check.check(teeth.motions, job.tool_of_operation(), teeth.likes);
  EXPECT_EQ(shared.motions, each.motions);
  EXPECT_LT(shared.distance_queries, each.distance_queries);
  EXPECT_EQ(check.passes(shared), check.passes(each));
  const double proof = job.check_options().limits.proof_mm;
  EXPECT_LE(shared.measured_mm, shared.bound_mm);
  EXPECT_LE(shared.bound_mm, each.measured_mm + proof + 1e-9) << "no looser than tooth by tooth";
  const auto seen = test::sampled(job, teeth.motions, job.tools[0].radius_mm(), 5);
  EXPECT_LE(seen.depth, shared.bound_mm);
  EXPECT_GE(shared.clearance_mm, each.clearance_mm - 0.02);
  EXPECT_LE(shared.clearance_mm, each.clearance_measured_mm + 1e-9);
}

TEST_P(LikeTeeth, PlantedCutsAreFoundWhereTheyAre) {
  const PlannedJob& job = job_named("spur");
  const double R = job.tools[0].radius_mm();
  const auto check = checker(job, GetParam());
  test::Random random(15);
  int planted = 0;
  for (int attempt = 0; attempt < 40 && planted < 6; ++attempt) {
    Teeth teeth = teeth_of(job, 3);
    const std::size_t k = teeth.of_tooth + random.index(teeth.motions.size() - teeth.of_tooth - 1);
    path::ToolMotion &m = teeth.motions[k], &next = teeth.motions[k + 1];
    if (m.tip_to != next.tip_from) continue;
    const auto q = job.part->nearest(m.tip_to + R * m.axis_to, R + 0.05);
    if (!q.exact || q.distance > R + 0.001) continue;
    const Vec3 into = turned((q.foot - q.point).normalized(), m.tooth * job.gear.pitch());
    const double by = q.distance - R + 0.0025;
    m.tip_to += by * into;
    next.tip_from = m.tip_to;
    for (const std::size_t n : {k, k + 1}) {
      auto& like = teeth.likes[n - teeth.of_tooth];
      ASSERT_EQ(like.motion, n);
      like.tip_mm += float(1.001 * std::abs(by));
    }
    const auto deepest = job.part->nearest(m.tip_to + R * m.axis_to, R + 0.05);
    if (!(R - deepest.distance > 0.0021)) continue;  // the other flank, or an edge, is nearer
    ++planted;
    const auto found = check.check(teeth.motions, job.tool_of_operation(), teeth.likes);
    EXPECT_FALSE(check.passes(found));
    EXPECT_GE(found.measured_mm, R - deepest.distance - 2e-4) << "motion " << k;
    EXPECT_GE(found.bound_mm, R - deepest.distance);
    EXPECT_TRUE(found.deepest.line == m.line || found.deepest.line == next.line) << found.deepest.line;
    EXPECT_EQ(found.deepest.tooth, m.tooth);
  }
  EXPECT_EQ(planted, 6);
}

// Motions that come one by one, numbered by first teeth alone: what is said is that of the list.
TEST_P(LikeTeeth, ComeOneByOne) {
  const PlannedJob& job = job_named("spur");
  Teeth teeth = teeth_of(job, 5);
  // Some of later teeth are like no others, ahead of, among and behind those that are.
  test::Random random(16);
  std::erase_if(teeth.likes, [&](const auto&) { return random.index(5) == 0; });
  teeth.motions[teeth.of_tooth + 40].tip_to.z() -= 0.01;
  for (const double tolerance : {0.002, 0.02}) {
    auto options = job.check_options();
    options.limits.gouge_mm = tolerance;
    auto tools = tool::proof_tools(job.tools);
    if (GetParam())
      for (auto& tool : tools) tool.ball_mill.reset();
    const analytic::GougeCheck check(*job.part, tools, options);
    const auto whole = check.check(teeth.motions, job.tool_of_operation(), teeth.likes);
    const auto of_operation = job.tool_of_operation();
    analytic::GougeStream stream(check, of_operation, true);
    auto like = teeth.likes.begin();
    for (std::size_t k = 0; k < teeth.motions.size(); ++k)
      if (like != teeth.likes.end() && like->motion == k) ++like;
      else stream.own(teeth.motions[k], k < teeth.of_tooth ? std::optional(std::uint32_t(k)) : std::nullopt);
    for (const auto& as : teeth.likes) stream.like(teeth.motions[as.motion], as);
    expect_the_list(stream.finish(), whole);
    analytic::GougeStream alone(check, of_operation, false);
    for (const auto& m : teeth.motions) alone.own(m, {});
    expect_the_list(alone.finish(), check.check(teeth.motions, of_operation));
  }
}

TEST_P(LikeTeeth, SameAnswerOnAnyNumberOfThreads) {
  const PlannedJob& job = job_named("spur");
  const Teeth teeth = teeth_of(job, 3);
  const auto check = checker(job, GetParam());
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] { return check.check(teeth.motions, job.tool_of_operation(), teeth.likes); });
  };
  const auto one = on(1), three = on(3);
  EXPECT_EQ(std::memcmp(&one.measured_mm, &three.measured_mm, sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(&one.bound_mm, &three.bound_mm, sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(&one.clearance_mm, &three.clearance_mm, sizeof(double)), 0);
  EXPECT_EQ(one.bound_line, three.bound_line);
  EXPECT_EQ(one.distance_queries, three.distance_queries);
}

INSTANTIATE_TEST_SUITE_P(Tools, LikeTeeth, testing::Bool(), [](const auto& i) { return i.param ? "profile" : "ball"; });

}  // namespace
}  // namespace toothpath
