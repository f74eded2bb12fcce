// What a clean result and a bound mean: 200 small clean programs pass, a tenfold denser sampling of random motions
// (turning axes among them) never exceeds the bound.
#include "cam/analytic/body_sweep.h"
#include "cam/analytic/cutter_sweep.h"
#include "cam/analytic/gouge_check.h"
#include "cam/path/motion_blend.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_bodies.h"
#include "tests/support/face_part.h"

namespace toothpath {
namespace {

using test::job_named;
using test::PlannedJob;

/// One pass along the space of a gear, the ball in contact, with its approach from above.
std::optional<path::ClPath> one_pass(const PlannedJob& job, test::Random& random, double R, double above) {
  const int zone = int(random.index(std::size_t(job.part->zones())));
  const auto& ring = test::sheet_of(job.part->space(zone)).ring().zone;
  const double length = ring.outer_radius_mm - ring.inner_radius_mm;
  const double from = ring.inner_radius_mm + random(0.1, 0.5) * length, to = from + random(0.05, 0.3) * length;
  const tooth_space::OffsetSheet sheet(job.part->space(zone), R + above, from - 0.2, to + 0.2, 9);
  if (sheet.empty() || sheet.r_from() > from || sheet.r_to() < to) return {};
  const double sigma = random(0.6, 4.4);
  const int steps = 2 + int((to - from) / std::sqrt(8 * R * 1e-3));  // short blocks: little sag
  path::ClPath path;
  path.operation_type = "finishing";
  for (int k = 0; k <= steps; ++k) {
    const auto s = sheet.at(sigma, from + (to - from) * k / steps);
    if (!s) return {};
    path.records.push_back({s->centre - Vec3(0, 0, R), Vec3::UnitZ(), 300, path::MoveKind::feed, zone, 0});
  }
  const double high = job.gear.blank_top() + 2;
  const auto lifted = [&](path::ClRecord r, path::MoveKind kind) {
    r.tip.z() = high;
    r.kind = kind;
    return r;
  };
  path.records.insert(path.records.begin(), lifted(path.records.front(), path::MoveKind::rapid));
  path.records[1].kind = path::MoveKind::engage;
  path.records.push_back(lifted(path.records.back(), path::MoveKind::retract));
  path.records.push_back(lifted(path.records.front(), path::MoveKind::rapid));
  return path;
}

class CleanPrograms : public testing::TestWithParam<const char*> {};

TEST_P(CleanPrograms, NoneIsReported) {
  const auto& job = job_named(GetParam());
  const test::BruteForceGearSolid brute(job.gear, 14, 20);
  test::Random random(2024);
  const double R_job = job.tools.back().radius_mm(), roof = job.gear.blank_top();
  int clean = 0;
  for (int attempt = 0; attempt < 400 && clean < 50; ++attempt) {
    const double R = R_job * random(0.5, 0.95), tolerance = random(0.001, 0.005);
    const auto path = one_pass(job, random, R, random(0, 0.002));
    if (!path) continue;
    // By construction: the flute is longer than any tooth is high, shank and holder stay above the blank.
    tool::ToolAssembly tool =
        test::ball_mill(2 * R, 8 * job.gear.parameters().module_mm, 1.9 * R, 9 * job.gear.parameters().module_mm, 10);
    // And by brute force: ball and flute against the sampled surfaces.
    double worst = -INFINITY;
    for (std::size_t k = 2; k + 2 < path->records.size(); k += 1 + path->records.size() / 4)
      for (const double t : {0.0, 0.5})
        for (const double h : {0.0, 0.7 * R}) {
          const Vec3 c = (1 - t) * path->records[k].tip + t * path->records[k + 1].tip + Vec3(0, 0, R + h);
          worst = std::max(worst, R - brute.nearest(c).distance);
        }
    if (worst > tolerance - 3e-4) continue;
    ++clean;
    auto options = job.check_options();
    options.limits.gouge_mm = tolerance;
    options.rapid_height_mm = roof;
    const analytic::GougeCheck check(*job.part, {tool}, options);
    const auto r = check.check(analytic::GougeCheck::motions_of(*path), {0});
    EXPECT_TRUE(check.passes(r)) << attempt << ": brute force " << worst << " measured " << r.measured_mm << " bound "
                                 << r.bound_mm << " limit " << tolerance << " clearance " << r.clearance_mm
                                 << " rapids " << r.rapids_clear;
    EXPECT_TRUE(r.worst.empty());
    EXPECT_GE(r.bound_mm, r.measured_mm);
    EXPECT_GE(r.bound_mm, worst - 1e-6);
  }
  EXPECT_EQ(clean, 50);
}

INSTANTIATE_TEST_SUITE_P(Jobs, CleanPrograms, testing::Values("spur", "offset", "conical", "dhfg"),
                         [](const auto& c) { return std::string(c.param); });

class RandomMotions : public testing::TestWithParam<const char*> {};

TEST_P(RandomMotions, TenfoldSamplingNeverExceedsTheBound) {
  const auto& job = job_named(GetParam());
  const auto& path = job.plan.paths.back();
  test::Random random(99);
  auto tool = job.tool(path.operation);
  tool.flute_length_mm = tool.radius_mm() + 1.5;
  tool.stick_out_mm = tool.flute_length_mm + 2;
  const double R = tool.radius_mm(), looked = R + std::max(0.12, 0.2 * R);  // as far as the sweep looks
  const auto options = job.check_options();
  int turning = 0;
  for (int k = 0; k < 60; ++k) {
    const auto& record = path.records[2 + random.index(path.records.size() - 4)];
    const auto wander = [&](double size) {
      return Vec3(random(-size, size), random(-size, size), random(-size, size));
    };
    path::ToolMotion m;
    m.axis_from = (record.axis + wander(0.2)).normalized();
    m.axis_to = k % 2 == 0 ? m.axis_from : Vec3((m.axis_from + wander(0.3)).normalized());
    m.tip_from = record.tip + wander(0.02) + Vec3(0, 0, random(0, 0.2));
    m.tip_to = m.tip_from + wander(k % 3 == 0 ? 2.0 : 0.3);
    turning += m.axis_from != m.axis_to;
    analytic::CutterSweep sweep(*job.part, tool, options.limits.proof_mm, options.limits.gouge_mm);
    const auto found = sweep.check(m);
    EXPECT_GE(found.bound_mm, found.measured_mm);
    const int steps = 10 * int(std::max<std::size_t>(20, std::min<std::size_t>(sweep.queries(), 60)));
    double deepest = -INFINITY;
    for (int s = 0; s <= steps; ++s) {
      const double t = double(s) / steps;
      for (const double h : {0.0, 0.05 * R, 0.3 * R, R, tool.flute_length_mm - R}) {
        const auto q = job.part->nearest(path::tip_at(m, t) + (R + h) * path::axis_at(m, t), looked);
        deepest = std::max(deepest, R - q.distance);
      }
    }
    EXPECT_GE(found.bound_mm, std::min(deepest, R + looked) - 1e-9) << k;  // a wreck is told as that
  }
  EXPECT_GE(turning, 20);
}

INSTANTIATE_TEST_SUITE_P(Jobs, RandomMotions, testing::Values("spur", "conical"),
                         [](const auto& c) { return std::string(c.param); });

// A tool that slides down along the end of the ring, a little too deep: told as that, in no endless time.
TEST(CutterSweep, ALongSlideThatIsTooDeepEndsSoon) {
  const auto& job = job_named("spur");
  auto tool = job.tool(job.plan.paths.back().operation);
  tool.flute_length_mm = tool.radius_mm() + 3;
  const double R = tool.radius_mm(), depth = 0.02, x = job.gear.outer_radius() + R - depth;
  const auto options = job.check_options();
  analytic::CutterSweep sweep(*job.part, tool, options.limits.proof_mm, options.limits.gouge_mm);
  path::ToolMotion m;
  m.axis_from = m.axis_to = Vec3::UnitZ();
  m.tip_from = Vec3(x, 0, job.gear.blank_top() + 5);
  m.tip_to = Vec3(x, 0, job.gear.blank_top() - 150);
  const auto found = sweep.check(m);
  EXPECT_GT(found.measured_mm, options.limits.gouge_mm);
  EXPECT_GE(found.bound_mm, found.measured_mm);
  EXPECT_LT(found.bound_mm, 5 * found.measured_mm);
  EXPECT_LT(sweep.queries(), 20000u);
}

// A control that may lean the tool by degrees: the bound covers every lean, and the search for it ends.
TEST_P(RandomMotions, AWideToleranceOfTheAxisIsBoundedInFewDistances) {
  const auto& job = job_named(GetParam());
  const auto& path = job.plan.paths.back();
  test::Random random(7);
  auto tool = job.tool(path.operation);
  tool.flute_length_mm = tool.radius_mm() + 3;
  const double R = tool.radius_mm();
  const auto options = job.check_options();
  for (const double lean : {1e-4, 3e-3, 2e-2}) {
    analytic::CutterSweep sweep(*job.part, tool, options.limits.proof_mm, options.limits.gouge_mm);
    double margin = INFINITY;
    for (int k = 0; k < 40; ++k) {
      const std::size_t i = 2 + random.index(path.records.size() - 4);
      const auto &a = path.records[i], &b = path.records[i + 1];
      path::ToolMotion m;
      m.tip_from = a.tip, m.tip_to = b.tip, m.axis_from = a.axis, m.axis_to = b.axis;
      m.deviation_mm = 1e-4;
      m.axis_deviation = lean;
      const auto found = sweep.check(m);
      for (int n = 0; n < 60; ++n) {
        const double t = random(0, 1), h = random(0, tool.flute_length_mm - R);
        const Vec3 u = path::axis_at(m, t),
                   aside = u.cross(Vec3(random(-1, 1), random(-1, 1), random(-1, 1))).normalized();
        const auto q =
            job.part->nearest(path::tip_at(m, t) + (R + h) * (std::cos(lean) * u + std::sin(lean) * aside), R + 0.3);
        margin = std::min(margin, found.bound_mm - (R - q.distance));
      }
    }
    EXPECT_GE(margin, -1e-9) << lean;
    EXPECT_LT(sweep.queries(), 60000u) << lean;
  }
}

class RandomBodies : public testing::TestWithParam<const char*> {};

/// Shank and holder of stubby tools in random motions, half of them turning, against the sampled solid at ten times as
/// many moments as the motion would need to look at: no place comes nearer than the proven gap, and what is measured is
/// a gap that exists.
TEST_P(RandomBodies, TenfoldSamplingNeverExceedsTheBound) {
  const auto& job = job_named(GetParam());
  const auto& path = job.plan.paths.back();
  const test::BruteForceBodies brute(job.gear);
  test::Random random(123);
  const double roof = job.gear.blank_top();
  int near = 0, cutting = 0, turning = 0;
  for (int k = 0; k < 24; ++k) {
    const auto& record = path.records[2 + random.index(path.records.size() - 4)];
    const auto wander = [&](double size) {
      return Vec3(random(-size, size), random(-size, size), random(-size, size));
    };
    const double above = std::max(roof - record.tip.z(), 0.0), R = job.tool(path.operation).radius_mm();
    const double low = k % 2 == 0 ? R + random(0.1, 1.0) : above + random(-0.15, 0.2);
    const double r0 = k % 2 == 0 ? R * random(0.8, 1.0) : random(2, 6), r1 = k % 2 == 0 ? r0 : r0 * random(1.0, 1.3);
    const tool::Frustum body{low, low + random(3, 12), r0, r1, k % 2 == 0 ? tool::Body::shank : tool::Body::holder};
    path::ToolMotion m;
    m.axis_from = (record.axis + wander(0.12)).normalized();
    m.axis_to = k % 4 < 2 ? m.axis_from : Vec3((m.axis_from + wander(0.1)).normalized());
    m.tip_from = record.tip + Vec3(0, 0, random(0, 0.1));
    m.tip_to = m.tip_from + wander(k % 3 == 0 ? 1.5 : 0.2);
    analytic::SweptGapOptions options;
    options.enough_mm = 0.8;
    options.contact_mm = 0.005;
    const auto found = analytic::swept_gap(*job.part, body, m, options);
    const auto truth = brute.deepest({body.from, body.to, r0, r1, false}, m, 60, 6);
    EXPECT_LE(found.proven_mm, std::min(-truth.depth, options.enough_mm) + 1e-9) << k << " " << to_string(body.body);
    EXPECT_LE(found.proven_mm, found.measured_mm) << k;
    if (found.measured_mm < options.enough_mm) {
      near += 1;
      turning += m.axis_from != m.axis_to;
      // The gap that is told exists: at its place, at some moment.
      double there = INFINITY;
      for (int tooth = 0; tooth < job.gear.parameters().teeth; ++tooth) {
        const Vec3 p = turned(found.place, tooth * job.gear.pitch());
        if ((p - m.tip_from).norm() > body.to + r1 + 4) continue;
        for (int s = 0; s <= 1000; ++s)
          there = std::min(there, -test::depth_in_body(p, {body.from, body.to, r0, r1, false},
                                                       path::tip_at(m, s / 1000.0), path::axis_at(m, s / 1000.0)));
      }
      EXPECT_NEAR(found.measured_mm, there, 0.002 + 0.3 * std::max(0.0, -found.measured_mm)) << k << " " << found.patch;
    }
    cutting += found.measured_mm < 0;
  }
  EXPECT_GE(near, 8);
  EXPECT_GE(cutting, 2);
  EXPECT_GE(turning, 3);
  RecordProperty("near", near);
  RecordProperty("cutting", cutting);
}

// Cells that were found once for a chain of bodies tell of each body what it finds alone, in the last bit.
TEST_P(RandomBodies, AChainFindsWhatEachOfItsBodiesFinds) {
  const auto& job = job_named(GetParam());
  const auto& path = job.plan.paths.back();
  test::Random random(61);
  int near = 0;
  for (int k = 0; k < 30; ++k) {
    const auto& record = path.records[2 + random.index(path.records.size() - 4)];
    path::ToolMotion m;
    m.axis_from = (record.axis + random.vector(0.2)).normalized();
    m.axis_to = k % 3 == 0 ? m.axis_from : Vec3((m.axis_from + random.vector(0.05)).normalized());
    m.tip_from = record.tip + Vec3(0, 0, random(0, 0.3));
    m.tip_to = m.tip_from + random.vector(k % 4 == 0 ? 1.5 : 0.2);
    std::vector<tool::RoundedFrustum> chain;
    const double R = job.tool(path.operation).radius_mm(), slope = random(0, 0.2);
    double h = R, radius = 0;
    for (int n = 0; n < 8; ++n) {
      const double next = h + random(0.1, 0.8), wider = radius + slope * (next - h);
      chain.push_back({{h, next, radius, wider, tool::Body::flute}, R * random(0.9, 1.0)});
      h = next;
      radius = wider;
    }
    const analytic::NearCells all(*job.part, chain, m, 0.6);
    for (std::size_t n = 0; n < chain.size(); ++n) {
      analytic::SweptGapOptions options;
      options.touching = true;
      options.enough_mm = n % 2 == 0 ? 0.6 : 0.15;
      options.contact_mm = 0.01;
      const auto alone = analytic::swept_gap(*job.part, chain[n], m, options),
                 together = analytic::swept_gap(*job.part, chain[n], m, options, all);
      EXPECT_EQ(alone.proven_mm, together.proven_mm) << k << " " << n;
      EXPECT_EQ(alone.measured_mm, together.measured_mm) << k << " " << n;
      EXPECT_EQ(alone.place, together.place) << k << " " << n;
      EXPECT_EQ(alone.pieces, together.pieces) << k << " " << n;
      near += alone.measured_mm < options.enough_mm;
    }
  }
  EXPECT_GT(near, 60);
}

INSTANTIATE_TEST_SUITE_P(Jobs, RandomBodies, testing::Values("spur", "conical", "double"),
                         [](const auto& c) { return std::string(c.param); });

/// The straight-line bound against sets of random points: the sharpest case that it must cover.
TEST(LeastBetween, HoldsForEverySet) {
  test::Random random(5);
  for (int k = 0; k < 400; ++k) {
    std::vector<Vec3> set;
    for (std::size_t n = 0; n < 1 + random.index(4); ++n) set.push_back({random(-2, 2), random(0.1, 2), random(-2, 2)});
    const auto distance = [&](const Vec3& p) {
      double d = INFINITY;
      for (const auto& q : set) d = std::min(d, (p - q).norm());
      return d;
    };
    const Vec3 a(random(-1, 1), 0, 0), b(random(-1, 1), random(-0.2, 0.2), 0);
    const double bound = analytic::least_between(distance(a), distance(b), (b - a).norm());
    for (int s = 0; s <= 200; ++s) EXPECT_GE(distance(a + (b - a) * (s / 200.0)), bound - 1e-12);
  }
}

}  // namespace
}  // namespace toothpath
