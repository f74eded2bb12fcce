// Heights of micrometres that a plan must keep: a small allowance, and the cusps of the fillets.
#include "geometry/face_gear/offset_sheet.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

struct Segment {
  Vec3 from, to;
};
/// Ball centres of everything that is fed.
std::vector<Segment> fed(const path::ClPath& path, double ball_radius) {
  std::vector<Segment> out;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto &a = path.records[k - 1], &b = path.records[k];
    if (b.kind == path::MoveKind::feed) out.push_back({a.tip + ball_radius * a.axis, b.tip + ball_radius * b.axis});
  }
  return out;
}

double distance_to(const Segment& s, const Vec3& p) {
  const Vec3 way = s.to - s.from;
  const double t = way.squaredNorm() > 0 ? std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
  return (p - s.from - t * way).norm();
}

// The chord is a share of the allowance where that is smaller than what may be gouged: of every place of the way of the
// ball 0.8 of the allowance stays.
TEST(SmallHeights, AllowancesOfMicrometresAreLeft) {
  for (const double allowance : {0.005, 0.012}) {
    const face_gear::FaceGear gear = test::made(test::small_spur());
    const auto tool = test::ball_mill(1, 6, 0.95, 16, 10);
    const analytic::GearDistance part(gear, ball::reach_of({tool}));
    plan::Options options;
    options.limits.gouge_mm = 0.01;
    const auto plan = plan::plan_face_gear(part, {tool}, {test::finishing(0, 0.04, 0.01, allowance)}, options);
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
    const analytic::GearDistance part(gear, ball::reach_of({tool}));
    const auto plan = plan::plan_face_gear(part, {tool}, {test::finishing(0, c.scallop, c.chord)}, {});
    ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
    const auto segments = fed(plan.value().paths.front(), 0.5 * c.ball);
    const auto& space = part.space(0);
    const double inner = space.ring().zone.inner_radius_mm, outer = space.ring().zone.outer_radius_mm;
    const face_gear::OffsetSheet surface(space, 0, inner, outer, 17);
    constexpr int kRadii = 48, kPlaces = 480;
    double highest = 0, sigma_of_highest = 0, r_of_highest = 0;
    for (int j = 0; j <= kRadii; ++j) {
      const double r = inner + (outer - inner) * j / kRadii;
      std::vector<Segment> near;
      for (const auto& s : segments)
        if (std::abs(std::hypot(s.from.x(), s.from.y()) - r) < 3 * c.ball + (s.to - s.from).norm()) near.push_back(s);
      for (int k = 0; k <= kPlaces; ++k) {
        const double sigma = 1 + 3.0 * k / kPlaces;
        const auto at = surface.raw(sigma, r);
        if (!at) continue;
        double least = INFINITY;
        for (const auto& s : near) least = std::min(least, distance_to(s, at->contact.p));
        if (least - 0.5 * c.ball > highest) highest = least - 0.5 * c.ball, sigma_of_highest = sigma, r_of_highest = r;
      }
    }
    const auto& told = plan.value().operations.front();
    std::printf("%s ball %.2f: asked %.2f um, highest %.2f um at sigma %.3f, r %.3f, told %.2f um\n", c.gear, c.ball,
                1000 * c.scallop, 1000 * highest, sigma_of_highest, r_of_highest, 1000 * told.scallop_max_mm);
    EXPECT_GT(highest, 0.6 * c.scallop);
    EXPECT_LE(highest, c.scallop + told.chord_mm);
    EXPECT_GE(told.scallop_max_mm + told.chord_mm, highest);
    EXPECT_LE(told.scallop_max_mm, c.scallop);
  }
}

}  // namespace
}  // namespace toothpath
