// A ball wider than the fillet touches two walls of a corner at two radii: where its passes begin and end, and what it
// reaches past the crossing.
#include "cam/ball/corner_ends.h"

#include "cam/cut/cut_surface.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/face_part.h"

namespace toothpath {
namespace {

/// 87/15 at 70 deg, module 1: the root's normal stands 20 deg off the gear axis.
face_gear::FaceGearParameters leaning_gear() {
  face_gear::FaceGearParameters g;
  g.teeth = 87;
  g.shaper_teeth = 15;
  g.mate_teeth = 12;
  g.module_mm = 1;
  g.pressure_angle_rad = radians(20);
  g.addendum_coefficient = 0.6;
  g.shaft_angle_rad = radians(70);
  g.shaper_tip_radius_mm = 0.1;
  g.reference_radius_mm = 59.771;
  g.zones = {{radians(27.38), 60.227, 61.326}};
  return g;
}
constexpr double kBall = 0.35;

const test::PlannedJob& leaning_job() {
  static const auto job = test::planned(leaning_gear(), {test::ball_mill(2 * kBall, 2.174, 0.63, 9.311, 10)},
                                        {test::finishing(0, 0.004, 3e-4)});
  return job;
}
ball::FinishingOptions options_of(const path::MillingOperation& op) {
  ball::FinishingOptions o;
  o.ball_radius_mm = kBall;
  o.scallop_mm = path::ByRegion<double>::everywhere(op.scallop_mm);
  o.chord_mm = op.chord_tolerance_mm;
  o.run_out_mm = 0.5 * kBall;
  return o;
}
tooth_space::OffsetSheet sheet_of(const analytic::GearDistance& part, double ball) {
  const auto& zone = test::sheet_of(part.space(0)).ring().zone;
  return tooth_space::OffsetSheet(part.space(0), ball, zone.inner_radius_mm - ball - 0.1,
                                  zone.outer_radius_mm + ball + 0.1);
}
std::vector<ball::BallPass> ends_of(const analytic::GearDistance& part, const tooth_space::OffsetSheet& sheet,
                                    const ball::FinishingOptions& o) {
  const auto laid = plan_finishing(sheet, o);
  EXPECT_TRUE(laid);
  return plan_corner_ends(
      sheet, o, [&](const Vec3& c) { return part.nearest(c, o.ball_radius_mm + 0.01).distance; }, laid->passes);
}

TEST(CornerEnds, NothingThatTheBallReachesStaysHigherThanTheCusp) {
  const auto& job = leaning_job();
  cut::CutSurfaceOptions dense;
  dense.flank_rows = 12;
  dense.fillet_rows = 50;
  dense.columns = 49;
  const auto whole = cut::measure_cut_surface(*job.part, job.motions(), job.operations, job.tools, dense);
  EXPECT_GT(whole.unreached.points, 100u);
  EXPECT_LE(whole.finished.max_mm, job.operations[0].scallop_mm + 0.0005);

  // The last passes are those of the ends; without them the fault is there.
  const auto ends = ends_of(*job.part, sheet_of(*job.part, kBall), options_of(job.operations[0]));
  ASSERT_FALSE(ends.empty());
  auto plan = job.plan;
  int passes = 0;
  for (const auto& r : plan.paths[0].records) passes = std::max(passes, r.pass + 1);
  std::erase_if(plan.paths[0].records, [&](const path::ClRecord& r) { return r.pass >= passes - int(ends.size()); });
  const auto less = cut::measure_cut_surface(*job.part, analytic::GougeCheck::motions_of(plan.paths[0]), job.operations,
                                             job.tools, dense);
  EXPECT_GT(less.finished.max_mm, job.operations[0].scallop_mm + 0.0015);
}

TEST(CornerEnds, TouchThePartAndEndInTheCorner) {
  const auto& job = leaning_job();
  const auto& zone = test::sheet_of(job.part->space(0)).ring().zone;
  const auto sheet = sheet_of(*job.part, kBall);
  for (const auto& pass : ends_of(*job.part, sheet, options_of(job.operations[0]))) {
    int contacts = 0;
    double low = INFINITY, high = 0;
    for (const auto& p : pass.points) {
      if (!p.touching) continue;
      ++contacts;
      EXPECT_NEAR(job.part->nearest(p.centre, kBall + 0.01).distance, kBall, 6e-5);
      EXPECT_NEAR((p.centre - p.contact).norm(), kBall, 1e-9);
      low = std::min(low, std::hypot(p.contact.x(), p.contact.y()));
      high = std::max(high, std::hypot(p.contact.x(), p.contact.y()));
    }
    EXPECT_GE(contacts, 2);
    EXPECT_GE(low, zone.inner_radius_mm - 1e-6);
    EXPECT_LE(high, zone.outer_radius_mm + 1e-6);
    EXPECT_LT(std::min(low - zone.inner_radius_mm, zone.outer_radius_mm - high), 1e-6)
        << "a pass begins at an end of the ring";
    EXPECT_LT(high - low, 0.5 * (zone.outer_radius_mm - zone.inner_radius_mm));
    const auto& inside = pass.points.front().touching ? pass.points.front() : pass.points.back();
    double apart = INFINITY;
    const double r = std::hypot(inside.centre.x(), inside.centre.y());
    for (const auto& g : sheet.gaps(r))
      if (const auto corner = sheet.raw(g.from, r)) apart = std::min(apart, (corner->centre - inside.centre).norm());
    EXPECT_LT(apart, 1e-3) << "and ends where the corner closes";
  }
}

TEST(CornerEnds, ThereAreNoneWhereTheBallFitsOrBothWallsEndTogether) {
  const auto& job = leaning_job();
  auto o = options_of(job.operations[0]);
  o.ball_radius_mm = 0.05;
  EXPECT_TRUE(ends_of(*job.part, sheet_of(*job.part, 0.05), o).empty());

  const auto spur = test::made(test::small_spur());  // straight teeth, 90 deg: both contacts lie at one radius
  const analytic::GearDistance part(face_gear::part_of(spur), 1.5);
  const auto sheet = sheet_of(part, 0.8);
  ASSERT_TRUE(sheet.has_gaps());
  o.ball_radius_mm = 0.8;
  EXPECT_TRUE(ends_of(part, sheet, o).empty());
}

TEST(SheetCorners, AreToldApartByTheRootLandNotByItsMiddle) {
  EXPECT_EQ(tooth_space::corner_of({0.96, 2.503}), tooth_space::SheetCorner::plus);
  EXPECT_EQ(tooth_space::corner_of({2.51, 4.03}), tooth_space::SheetCorner::minus);
  EXPECT_EQ(tooth_space::corner_of({2.49, 4.03}), tooth_space::SheetCorner::minus);
  EXPECT_EQ(tooth_space::corner_of({1.2, 1.8}), tooth_space::SheetCorner::plus);
  EXPECT_EQ(tooth_space::corner_of({3.2, 3.9}), tooth_space::SheetCorner::minus);
  EXPECT_EQ(tooth_space::corner_of({0.96, 4.04}), tooth_space::SheetCorner::both);
}

/// One ring, everything read in the normal section.
face_gear::FaceGearParameters ring_gear(int teeth, int shaper_teeth, double module_mm, double tip_radius_mm,
                                        face_gear::FaceGearZone zone) {
  face_gear::FaceGearParameters g;
  g.teeth = teeth;
  g.shaper_teeth = shaper_teeth;
  g.module_mm = module_mm;
  g.pressure_angle_rad = radians(20);
  g.shaper_tip_radius_mm = tip_radius_mm;
  g.zones = {zone};
  return g;
}
struct WideBallCase {
  std::string name;
  face_gear::FaceGearParameters gear;
  double ball_mm = 0, scallop_mm = 0;
};
/// "one_corner": the ball never reaches the root land; its contacts lie 0.6 mm apart along a ring of 0.8 mm.
/// "two_corners": it reaches the land over a part of the ring, and the two corners meet away from the middle of the
/// land.
std::vector<WideBallCase> wide_balls() {
  auto one = ring_gear(104, 16, 1.63, 0.489, {radians(-30.55), 102.543, 103.358});
  one.clearance_coefficient = 0.3;
  one.offset_mm = -6.85;
  one.reference_radius_mm = 102.543;
  auto two = ring_gear(150, 39, 1.92, 0, {radians(-14.23), 154.8, 155.72});
  two.module_plane = face_gear::ModulePlane::transverse;
  two.pressure_angle_rad = radians(22.5);
  return {{"one_corner", one, 0.7335, 0.00815}, {"two_corners", two, 0.672, 0.0192}};
}
class WideBall : public testing::TestWithParam<WideBallCase> {};

TEST_P(WideBall, LeavesNoMoreThanTheCuspOnBothWallsAndCutsNothing) {
  const auto& [name, gear, ball, scallop] = GetParam();
  const auto job =
      test::planned(gear, {test::ball_mill(2 * ball, 5, 1.8 * ball, 20, 10)}, {test::finishing(0, scallop, 0.002)});
  const auto cut = cut::measure_cut_surface(*job.part, job.motions(), job.operations, job.tools);
  EXPECT_TRUE(job.plan.operations[0].corner_passes);
  EXPECT_LE(cut.finished.max_mm, scallop + 0.001);
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  EXPECT_TRUE(check.passes(check.check(job.motions(), job.tool_of_operation())));
}
INSTANTIATE_TEST_SUITE_P(Gears, WideBall, testing::ValuesIn(wide_balls()),
                         [](const auto& wide) { return wide.param.name; });

/// Balls that are too wide for the root of leaning teeth, on narrow rings: held by both walls all along, they come down
/// to a spot of the root land at the very end, where one wall has ended. All but "narrow" are random gears.
struct SpotCase {
  std::string name;
  int teeth = 0, shaper_teeth = 0;
  double module_mm = 0, pressure_angle = 0, shaft_angle = 0, offset_mm = 0, tip_radius_mm = 0, helix = 0, inner_mm = 0,
         outer_mm = 0, ball_mm = 0, scallop_mm = 0;
};
std::vector<SpotCase> spots() {
  return {{"narrow", 123, 36, 0.6, 22.699, 91.207, 0.3182, 0.054, 29.475, 44.5936, 45.3485, 0.45, 0.0074},
          {"wide", 70, 28, 1.1091, 19.617, 82.668, -0.7791, 0.0702, -20.984, 43.2884, 45.0542, 1.0310, 0.0039},
          {"left_hand", 100, 35, 0.7993, 19.235, 84.619, -0.5198, 0.1434, -29.394, 46.9341, 48.3639, 0.7720, 0.01028},
          {"small_ball", 136, 21, 0.9978, 24.435, 84.081, -0.8765, 0.1551, 30.093, 83.8173, 84.6385, 0.5273, 0.0074}};
}
class EndSpots : public testing::TestWithParam<SpotCase> {};

TEST_P(EndSpots, HavePassesOfTheirOwn) {
  const SpotCase& spot = GetParam();
  auto gear = ring_gear(spot.teeth, spot.shaper_teeth, spot.module_mm, spot.tip_radius_mm,
                        {radians(spot.helix), spot.inner_mm, spot.outer_mm});
  gear.pressure_angle_rad = radians(spot.pressure_angle);
  gear.shaft_angle_rad = radians(spot.shaft_angle);
  gear.offset_mm = spot.offset_mm;
  const double ball = spot.ball_mm, m_n = spot.module_mm;
  const auto job = test::planned(gear, {test::ball_mill(ball, 4 * m_n, 0.9 * ball, 6 * m_n, 10)},
                                 {test::finishing(0, spot.scallop_mm, 0.003)});
  cut::CutSurfaceOptions dense;
  dense.flank_rows = 4;
  dense.root_rows = 30;
  const auto cut = cut::measure_cut_surface(*job.part, job.motions(), job.operations, job.tools, dense);
  EXPECT_LE(cut.finished.max_mm, spot.scallop_mm + 0.001);
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  EXPECT_TRUE(check.passes(check.check(job.motions(), job.tool_of_operation())));
}
INSTANTIATE_TEST_SUITE_P(Gears, EndSpots, testing::ValuesIn(spots()), [](const auto& spot) { return spot.param.name; });

}  // namespace
}  // namespace toothpath
