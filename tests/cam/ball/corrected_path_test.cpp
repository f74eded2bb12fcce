// Paths for corrected flanks: what they leave against the corrected target, and with the process error that they answer
// against the nominal one.
#include "cam/cut/cut_surface.h"
#include "cam/cut/swept_path.h"
#include "geometry/face_gear/part.h"
#include "geometry/modification/flank_correction.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/inspection_points.h"

namespace toothpath::test {
namespace {

/// 20 um, another field on each side; x along the profile, y along the face, 0 .. 1 on the grid.
double process_error(int side, double x, double y) {
  const double u = 2 * x - 1, v = 2 * y - 1;
  return side > 0 ? 0.020 * (0.35 * v + 0.4 * u * v - 0.25 * v * v + 0.1 * u * u)
                  : -0.020 * (0.3 * u - 0.4 * v * v * u + 0.3 * v);
}

face_gear::FaceGearParameters short_spur() {
  auto g = small_spur();
  g.zones = {{0, 60, 62}};
  return g;
}

face_gear::FaceGear corrected(const face_gear::FaceGear& nominal) {
  modification::RingCorrection ring;
  for (const int side : {1, -1}) {
    std::vector<modification::FlankDeviation> points;
    for (const auto& p : grid_of(nominal, 5, 9))
      if (p.side == side)
        points.push_back(
            {p.row, p.column, p.theta, std::hypot(p.p.x(), p.p.y()), process_error(side, p.row / 4.0, p.column / 8.0)});
    (side > 0 ? ring.plus : ring.minus) =
        *modification::FlankCorrection::fit(points, nominal.rings()[0].surface.shaper.theta_t);
  }
  return nominal.corrected({std::make_shared<modification::RingCorrection>(ring)});
}

TEST(CorrectedPath, PlannedAndProvenAgainstTheCorrectedFlanksAndWrongForTheOthers) {
  const face_gear::FaceGear nominal = made(short_spur());
  const std::vector<tool::ToolAssembly> tools = {ball_mill(1, 6, 0.95, 16, 10)};
  const std::vector<path::MillingOperation> operations = {finishing(0, 3e-4, 3e-4)};
  PlannedJob job{corrected(nominal), tools, operations, nullptr, {}};
  job.part = std::make_unique<analytic::GearDistance>(face_gear::part_of(job.gear), ball::reach_of(tools));
  auto plan = plan::plan_milling(*job.part, tools, operations, {});
  ASSERT_TRUE(plan.has_value()) << plan.error().diagnostic.message;
  job.plan = std::move(plan).value();
  const auto motions = job.motions();

  // Against its own target it is no gouge; against the nominal flanks it cuts as deep as the correction.
  const analytic::GougeCheck check(*job.part, tools, job.check_options());
  const auto own = check.check(motions, {0});
  EXPECT_LT(own.bound_mm, 0.002);
  const analytic::GearDistance plain(face_gear::part_of(nominal), ball::reach_of(tools));
  const auto other = analytic::GougeCheck(plain, tools, job.check_options()).check(motions, {0});
  EXPECT_GT(other.measured_mm, 0.012);
  EXPECT_LT(other.measured_mm, 0.030);

  // The process adds its error to what the path leaves of the nominal flank: almost nothing stays.
  std::vector<cut::BallMove> moves;
  for (const auto& m : motions)
    if (!m.rapid) moves.push_back({m.tip_from + 0.5 * m.axis_from, m.tip_to + 0.5 * m.axis_to});
  const cut::SweptPath swept(std::move(moves), 0.5);
  for (const auto& [rows, columns] : {std::pair{5, 9}, std::pair{13, 25}}) {
    double left = 0;
    for (const auto& p : grid_of(nominal, rows, columns)) {
      const Vec3 at = p.side > 0 ? p.p : turned(p.p, nominal.pitch());
      left = std::max(left, std::abs(swept.excess(at, 1.0) + process_error(p.side, double(p.row) / (rows - 1),
                                                                           double(p.column) / (columns - 1))));
    }
    std::printf("  %d x %d points: 20 um of error, %.3f um left\n", rows, columns, left * 1000);
    EXPECT_LT(left, 0.0005);
  }
}

}  // namespace
}  // namespace toothpath::test
