// Heights of micrometres that a plan must keep: a small allowance, the cusps of the fillets, and those that regions
// have of their own.
#include "cam/ball/finishing.h"
#include "geometry/face_gear/part.h"
#include "geometry/tooth_space/offset_sheet.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

struct Segment {
  Vec3 from, to;
  double ball_radius = 0;
};
/// Ways of the ball centre of everything that is fed.
std::vector<Segment> fed(const path::ClPath& path, double ball_radius) {
  std::vector<Segment> out;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto &a = path.records[k - 1], &b = path.records[k];
    if (b.kind == path::MoveKind::feed)
      out.push_back({a.tip + ball_radius * a.axis, b.tip + ball_radius * b.axis, ball_radius});
  }
  return out;
}

double distance_to(const Segment& s, const Vec3& p) {
  const Vec3 way = s.to - s.from;
  const double t = way.squaredNorm() > 0 ? std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
  return (p - s.from - t * way).norm();
}

/// The highest place of every region of the space, above the nearest ball.
struct Highest {
  double left = 0, sigma = 0, r = 0;
};
path::ByRegion<Highest> highest_places(const analytic::GearDistance& part, const std::vector<Segment>& segments,
                                       int radii = 48) {
  constexpr int kPlacesOfPiece = 160;
  const auto& space = test::sheet_of(part.space(0));
  const double inner = space.ring().zone.inner_radius_mm, outer = space.ring().zone.outer_radius_mm;
  const tooth_space::OffsetSheet surface(space, 0, inner, outer, 17);
  path::ByRegion<Highest> out;
  for (int j = 0; j <= radii; ++j) {
    const double r = inner + (outer - inner) * j / radii;
    std::vector<Segment> near;
    for (const auto& s : segments)
      if (std::abs(std::hypot(s.from.x(), s.from.y()) - r) < 6 * s.ball_radius + (s.to - s.from).norm())
        near.push_back(s);
    for (int k = 0; k <= 5 * kPlacesOfPiece; ++k) {
      const double sigma = double(k) / kPlacesOfPiece;
      const auto at = surface.raw(sigma, r);
      if (!at) continue;
      double left = INFINITY;
      for (const auto& s : near) left = std::min(left, distance_to(s, at->contact.p) - s.ball_radius);
      Highest& most = out[ball::FinishingOptions::region_at(sigma)];
      if (left > most.left) most = {left, sigma, r};
    }
  }
  return out;
}

// The chord is a share of the allowance where that is smaller than what may be gouged: of every place of the way of the
// ball 0.8 of the allowance stays.
TEST(SmallHeights, AllowancesOfMicrometresAreLeft) {
  for (const double allowance : {0.005, 0.012}) {
    const face_gear::FaceGear gear = test::made(test::small_spur());
    const auto tool = test::ball_mill(1, 6, 0.95, 16, 10);
    const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
    plan::Options options;
    options.limits.gouge_mm = 0.01;
    const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, 0.04, 0.01, allowance)}, options);
    ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
    double least = INFINITY;
    for (const auto& s : fed(plan.value().paths.front(), 0.5))
      for (int k = 0; k <= 8; ++k)
        least = std::min(least, part.nearest(s.from + k / 8.0 * (s.to - s.from), 0.6).distance - 0.5);
    EXPECT_GE(least, 0.8 * allowance) << allowance;
    EXPECT_LE(least, allowance) << allowance;
  }
}

struct CuspCase {
  const char* gear;
  double ball, flute, shank, scallop, chord;
};

// The surface that the balls leave, place by place on the exact surface: nothing in the fillets or on the root land
// stands above the cusp that was asked for, and what the plan tells of is no less than what stands there.
TEST(SmallHeights, CuspsOfTheFilletsAreAsAskedAndTold) {
  for (const auto& c : {CuspCase{"spur", 1, 6, 0.95, 0.02, 0.002}, CuspCase{"spur", 0.8, 6, 0.75, 0.006, 0.001},
                        CuspCase{"offset", 1.6, 8, 1.5, 0.02, 0.002}, CuspCase{"conical", 0.7, 6, 0.65, 0.01, 0.001}}) {
    const face_gear::FaceGear gear = test::made(test::gear_named(c.gear));
    const auto tool = test::ball_mill(c.ball, c.flute, c.shank, 16, 10);
    const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
    const auto plan = plan::plan_milling(part, {tool}, {test::finishing(0, c.scallop, c.chord)}, {});
    ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
    const auto most = highest_places(part, fed(plan.value().paths.front(), 0.5 * c.ball));
    const Highest &fillet = most[path::Region::fillet], &root = most[path::Region::root],
                  &worst = fillet.left > root.left ? fillet : root;
    const double highest = worst.left;
    const auto& told = plan.value().operations.front();
    std::printf("%s ball %.2f: asked %.2f um, highest %.2f um at sigma %.3f, r %.3f, told %.2f um\n", c.gear, c.ball,
                1000 * c.scallop, 1000 * highest, worst.sigma, worst.r, 1000 * told.scallop_max_mm);
    EXPECT_GT(highest, 0.6 * c.scallop);
    EXPECT_LE(highest, c.scallop + told.chord_mm);
    EXPECT_GE(told.scallop_max_mm + told.chord_mm, highest);
    EXPECT_LE(told.scallop_max_mm, c.scallop);
  }
}

// The flanks by one operation, fillets and root by another with a height for each: no height is asked where the other
// operation cuts.
TEST(SmallHeights, EveryRegionKeepsTheOneOfItsOwn) {
  for (const char* name : {"spur", "offset"}) {
    const face_gear::FaceGear gear = test::made(test::gear_named(name));
    const double ball = name == std::string("spur") ? 1 : 1.6, smaller = 0.8 * ball;
    const std::vector tools = {test::ball_mill(ball, 8, 0.95 * ball, 16, 10),
                               test::ball_mill(smaller, 8, 0.95 * smaller, 16, 10)};
    const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(tools));
    const path::ByRegion<double> asked{{0.008, 0.02, 0.012}};
    auto flanks = test::finishing(0, 0.008, 0.002), bottom = test::finishing(1, 0.02, 0.002);
    flanks.regions = {{true, false, false}};
    flanks.scallops_mm = {{0.008, 0, 0}};
    bottom.regions = {{false, true, true}};
    bottom.scallops_mm = {{0, 0.02, 0.012}};
    const auto plan = plan::plan_milling(part, tools, {flanks, bottom}, {});
    ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
    auto segments = fed(plan.value().paths[0], 0.5 * ball);
    const auto below = fed(plan.value().paths[1], 0.5 * smaller);
    segments.insert(segments.end(), below.begin(), below.end());
    const auto most = highest_places(part, segments);
    for (const path::Region region : path::kRegions) {
      SCOPED_TRACE(
          fmt::format("{} {} at sigma {:.3f}, r {:.3f}", name, to_string(region), most[region].sigma, most[region].r));
      EXPECT_LE(most[region].left, asked[region] + 0.002);
      EXPECT_GT(most[region].left, 0.3 * asked[region]);
    }
  }
}

// Operations that share the regions of a space: between the last pass of the one and the first of the other nothing
// stands higher than asked, with a ball that touches two walls of a corner, too.
TEST(SmallHeights, BordersBetweenOperationsKeepTheCusp) {
  auto parameters = test::small_spur();
  parameters.zones.front().outer_radius_mm = 61;
  const face_gear::FaceGear gear = test::made(parameters);
  constexpr double kAsked = 0.014;
  constexpr double ball = 1.5;
  for (const path::ByRegion<bool>& first : {path::ByRegion<bool>{{true, false, false}}, {{true, false, true}}}) {
    const std::vector tools = {test::ball_mill(ball, 6, 0.95 * ball, 16, 10)};
    const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(tools));
    std::vector operations = {test::finishing(0, kAsked, 0.002), test::finishing(0, kAsked, 0.002)};
    operations[0].regions = first;
    for (const path::Region region : path::kRegions) operations[1].regions[region] = !first[region];
    const auto plan = plan::plan_milling(part, tools, operations, {});
    ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
    auto segments = fed(plan.value().paths[0], 0.5 * ball);
    const auto below = fed(plan.value().paths[1], 0.5 * ball);
    segments.insert(segments.end(), below.begin(), below.end());
    const Highest flank = highest_places(part, segments, 6)[path::Region::flank];
    EXPECT_LE(flank.left, kAsked + 0.002)
        << ball << " " << first[path::Region::fillet] << first[path::Region::root] << " sigma " << flank.sigma;
  }
}

// Every number by itself may be asked for: together they would fill the memory.
TEST(SmallSteps, AreRefusedBeforeTheyFillTheMemory) {
  const auto gear = test::made(test::small_spur());
  const std::vector<tool::ToolAssembly> tools = {test::ball_mill(1, 5.2, 0.95, 16, 10)};
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(tools));
  plan::Options options;
  options.trial = true;
  const auto planned = plan::plan_milling(part, tools, {test::roughing(0, 0.001, 0.001, 0.1)}, options);
  ASSERT_TRUE(planned.refused());
  EXPECT_NE(planned.refused()->diagnostic.message.find("step_down = 0.001 mm and step_over = 0.001 mm"),
            std::string::npos)
      << planned.refused()->diagnostic.message;
}

}  // namespace
}  // namespace toothpath
