// What the programs leave: the measured cut surface against dense sampling, and the promises of the planner.
#include "cam/cut/cut_surface.h"

#include "cam/cut/swept_tool.h"
#include "cam/cut/zone_places.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

using test::job_named;
using test::PlannedJob;

cut::CutSurface surface(const PlannedJob& job, const std::vector<path::ToolMotion>& motions) {
  return cut::measure_cut_surface(*job.part, motions, job.operations, job.tools);
}

TEST(CutSurface, AgreesWithDenselySampledTubes) {
  const auto& job = job_named("spur");
  cut::CutSurfaceOptions few;
  few.flank_rows = 6;
  few.fillet_rows = 4;
  few.root_rows = 3;
  few.columns = 4;
  const auto motions = job.motions();
  const auto cut = cut::measure_cut_surface(*job.part, motions, job.operations, job.tools, few);
  const double cap = job.gear.parameters().module_mm;
  for (const auto& g : cut.grids)
    for (std::size_t k = 0; k < g.points.size(); ++k) {
      double least = cap;
      std::size_t next = 0;
      for (std::size_t n = 0; n < job.operations.size(); ++n) {
        const double R = job.tool(int(n)).radius_mm();
        for (; next < motions.size() && motions[next].operation == int(n); ++next) {
          const auto& m = motions[next];
          if (m.rapid) continue;
          const double length = (m.tip_to - m.tip_from).norm();
          if ((g.points[k] - m.tip_from - R * m.axis_from).norm() - length > R + least) continue;
          const int steps = 1 + int(length / 0.002);
          for (int s = 0; s <= steps; ++s) {
            const double t = double(s) / steps;
            least = std::min(least, (g.points[k] - (1 - t) * m.tip_from - t * m.tip_to - R * m.axis_from).norm() - R);
          }
        }
        EXPECT_NEAR(double(g.excess_um[n][k]) / 1000, least, 1e-5 + 1e-6 * least)
            << to_string(g.patch) << " operation " << n;
      }
    }
}

TEST(CutSurface, ADroppedPassShowsUp) {
  const auto& job = job_named("spur");
  const auto whole = surface(job, job.motions());
  auto plan = job.plan;
  auto& records = plan.paths.back().records;
  std::erase_if(records, [](const path::ClRecord& r) { return r.pass == 4; });
  std::vector<path::ToolMotion> motions;
  for (const auto& p : plan.paths) {
    const auto m = analytic::GougeCheck::motions_of(p);
    motions.insert(motions.end(), m.begin(), m.end());
  }
  const auto less = surface(job, motions);
  EXPECT_GT(less.finished.max_mm, whole.finished.max_mm + job.operations.back().scallop_mm);
}

TEST(CutSurface, ASmallerBallShowsUp) {
  const auto& job = job_named("spur");
  auto tools = job.tools;
  tools[0].diameter_mm -= 0.02;
  const auto smaller = cut::measure_cut_surface(*job.part, job.motions(), job.operations, tools);
  EXPECT_GT(smaller.finished.min_mm + 1e-6, surface(job, job.motions()).finished.min_mm);
  EXPECT_GT(smaller.finished.max_mm, surface(job, job.motions()).finished.max_mm + 0.004);
}

// High cusps of small balls: between the samples, and along the normal, where a crest stands higher than it is far from
// the balls. Brute force: from places of the surface outwards until a ball has been there.
TEST(CutSurface, TheBoundHoldsAlongTheNormal) {
  for (const auto& [diameter, scallop] : {std::pair(0.44, 0.03), {0.6, 0.04}}) {
    auto gear = test::small_spur();
    gear.zones[0].outer_radius_mm = gear.zones[0].inner_radius_mm + 1.5;
    const auto job = test::planned(gear, {test::ball_mill(diameter, 5.2, 0.95 * diameter, 16, 10)},
                                   {test::finishing(0, scallop, 6e-4)});
    const auto cut = surface(job, job.motions());
    const double R = 0.5 * diameter;
    const cut::Removed removed(job.motions(), tool::proof_tool(job.tools[0]), job.gear.blank_top());
    const cut::ZonePlaces places(*job.part, 0);
    double highest = 0;
    for (const double share : {0.0, 0.07, 0.31, 0.55, 0.83, 1.0}) {
      const double r = places.radius(share);
      for (int piece = 0; piece < tooth_space::kPieces; ++piece) {
        const auto [from, to] = places.range(tooth_space::Piece(piece), r);
        for (int k = 0; k <= 500; ++k) {
          const auto s = places.at(from + (to - from) * k / 500, r);
          if (!s) continue;
          const auto& [p, n] = std::pair(s->contact.p, s->contact.n);
          double height = removed.excess(p, 1);
          if (height < 0.8 * highest || job.part->nearest(p + R * n, R + 0.01).distance < R - 1e-4) continue;
          for (double step = height; step > 1e-7; height += step) step = removed.excess(p + height * n, 1);
          highest = std::max(highest, height);
        }
      }
    }
    EXPECT_GT(highest, scallop) << diameter;
    EXPECT_LE(highest, cut.finished.bound_mm) << diameter;
    EXPECT_LE(cut.finished.bound_mm, 1.25 * highest) << diameter;
  }
}

// Where the ball is about to touch a second wall, that wall is no second opinion about the first.
TEST(CutSurface, SolversAreComparedAtOnePlaceOnly) {
  face_gear::FaceGearParameters g;
  g.teeth = 138;
  g.shaper_teeth = 36;
  g.module_mm = 0.58;
  g.pressure_angle_rad = radians(22.5);
  g.addendum_coefficient = 0.6;
  g.reference_radius_mm = 48.344;
  g.shaper_tip_radius_mm = 0.1612;
  g.backlash_mm = 0.0058;
  g.zones = {{radians(25.47), 47.31, 47.89}};
  const auto gear = test::made(g);
  const analytic::GearDistance part(face_gear::part_of(gear), 1.0);
  // The residual needs the tool, not its path.
  const auto cut = cut::measure_cut_surface(part, {}, {test::finishing(0, 0.0087, 0.005, 0.0104)},
                                            {test::ball_mill(0.29, 1, 0.29, 8, 10)});
  EXPECT_LE(cut.solve_residual_mm, 1e-9);
  EXPECT_GT(cut.solve_residual_mm, 0);
}

class Promises : public testing::TestWithParam<std::string> {};

TEST_P(Promises, AllowanceStaysAndFinishingLeavesOnlyCusps) {
  const auto& job = job_named(GetParam());
  const auto cut = surface(job, job.motions());
  for (std::size_t n = 0; n < job.operations.size(); ++n) {
    const auto& op = job.operations[n];
    const double least = op.allowance_mm > 0 ? 0.8 * op.allowance_mm : -0.001;
    EXPECT_GE(cut.operations[n].min_mm, least) << "operation " << n;
  }
  const auto& last = job.operations.back();
  EXPECT_LE(cut.finished.max_mm, last.scallop_mm + 0.001);
  EXPECT_EQ(cut.scallop.requested_mm, last.scallop_mm);
  if (GetParam() != "dhfg") return;
  EXPECT_GE(cut.scallop.share_within, 0.95) << cut.scallop.reached_min_mm << " .. " << cut.scallop.reached_max_mm;
}
INSTANTIATE_TEST_SUITE_P(Jobs, Promises, testing::Values("dhfg", "offset", "conical", "spur"),
                         [](const auto& job_case) { return job_case.param; });

// A ball wider than the fillet leaves the corner. Where both corners of the root become one inside the ring, passes of
// such a ball may cut too deep; then the check must say so, and no program is written.
TEST(WideBall, LeavesTheCornerAndCutsNothing) {
  const auto& job = job_named("spur wide");
  const auto cut = surface(job, job.motions());
  EXPECT_GT(cut.unreached.points, 10u);
  EXPECT_GT(cut.unreached.max_height_mm, 0.005);
  EXPECT_TRUE(job.plan.operations.back().corner_passes);
  const analytic::GougeCheckOptions options{.limits = {}, .rapid_height_mm = job.gear.blank_top()};
  const analytic::GougeCheck check(*job.part, job.tools, options);
  const auto gouge = check.check(job.motions(), job.tool_of_operation());
  EXPECT_GE(gouge.bound_mm, -cut.operations.back().min_mm);
  EXPECT_LE(gouge.bound_mm, options.limits.gouge_mm);
  EXPECT_TRUE(check.passes(gouge));
  EXPECT_EQ(surface(job_named("spur"), job_named("spur").motions()).unreached.points, 0u);
}

TEST(Feed, ClimbsOnBothFlanksAndKeepsTheContactSpeed) {
  for (const char* name : {"dhfg", "offset", "conical", "spur"}) {
    const auto& job = job_named(name);
    const auto& path = job.plan.paths.back();
    const double R = job.tool(path.operation).radius_mm(), asked = job.operations.back().feed_mm_min;
    int plus = 0, minus = 0, fast = 0, within = 0, contacts = 0;
    for (std::size_t k = 1; k < path.records.size(); ++k) {
      const auto &a = path.records[k - 1], &b = path.records[k];
      if (b.kind != path::MoveKind::feed) continue;
      EXPECT_LE(b.feed_mm_min, 1.2 * asked + 1e-9);
      EXPECT_GT(b.feed_mm_min, 0);
      const auto qa = job.part->nearest(a.tip + R * a.axis, R + 0.05),
                 qb = job.part->nearest(b.tip + R * b.axis, R + 0.05);
      if (!qa.exact || !qb.exact || std::string(qa.patch) != qb.patch) continue;
      const bool on_plus = std::string(qb.patch) == "flank +1", on_minus = std::string(qb.patch) == "flank -1";
      if (on_plus || on_minus) {
        const Vec3 right = (b.tip - a.tip).cross(b.axis);
        EXPECT_GT((qb.foot - qb.point).dot(right), 0) << name << " " << qb.patch;
        ++(on_plus ? plus : minus);
      }
      ++contacts;
      const double contact_feed = b.feed_mm_min * (qb.foot - qa.foot).norm() / (b.tip - a.tip).norm();
      fast += contact_feed > 1.2 * asked;
      within += std::abs(contact_feed - asked) < 0.2 * asked;
    }
    EXPECT_GT(plus, 10) << name;
    EXPECT_GT(minus, 10) << name;
    EXPECT_EQ(fast, 0) << name;
    EXPECT_GE(within, 9 * contacts / 10) << name;
  }
}

}  // namespace
}  // namespace toothpath
