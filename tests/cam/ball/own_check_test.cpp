// A plan passes its own check, or the planner says what keeps it from one, and what would help.
#include "cam/analytic/body_sweep.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

/// Helical teeth that end 0.5 mm farther out, close to where a fillet folds: there its bend has no proven bound.
face_gear::FaceGearParameters short_helical_gear() {
  face_gear::FaceGearParameters g;
  g.teeth = 90;
  g.shaper_teeth = 55;
  g.module_mm = 0.6;
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(14.69);
  g.shaft_angle_rad = radians(87.9);
  g.offset_mm = 0.23;
  g.shaper_tip_radius_mm = 0.15;
  g.zones = {{radians(25.5), 28.066, 28.546}};
  return g;
}

TEST(OwnCheck, AGapIsProvenBesideAFoldedFillet) {
  auto tool = test::ball_mill(0.45, 0.68, 0.305, 7.05, 12);
  const auto job = test::planned(short_helical_gear(), {tool}, {test::roughing(0, 0.2, 0.214, 0.027)});
  EXPECT_GT(job.part->unproven(), 0u);  // what this is about
  auto options = job.check_options();
  options.limits.gouge_mm = 0.003;
  const auto passed = analytic::GougeCheck(*job.part, job.tools, options).check_path(job.plan.paths[0]);
  EXPECT_TRUE(passed) << passed.error().message;
  analytic::SweptGapOptions look;
  look.enough_mm = 0.75;
  std::size_t most = 0;
  for (const auto& m : job.motions())
    most = std::max(most, analytic::swept_gap(*job.part, tool::shank_and_holder(tool).front(), m, look).pieces);
  EXPECT_LT(most, 20000u);
}

// A gap that is found to be as large as asked is followed until that is proven, however little it is more.
TEST(OwnCheck, AGapThatIsHardlyMoreThanAskedIsProven) {
  const auto& job = test::job_named("spur");
  const auto& path = job.plan.paths.back();
  const double R = job.tool(path.operation).radius_mm();
  int undecided = 0;
  for (std::size_t k = 5; k + 1 < path.records.size(); k += path.records.size() / 40) {
    const auto& record = path.records[k];
    const tool::Frustum shank{2 * R, 8, R + 0.12, R + 0.12, tool::Body::shank};
    path::ToolMotion m;
    m.tip_from = record.tip;
    m.tip_to = record.tip + Vec3(0.05, 0.02, 0);
    m.axis_from = m.axis_to = record.axis;
    analytic::SweptGapOptions look;
    look.contact_mm = 0.005;
    const auto plain = analytic::swept_gap(*job.part, shank, m, look);
    if (plain.measured_mm < 0.01 || plain.measured_mm >= look.enough_mm) continue;
    look.asked_mm = plain.measured_mm - 0.0005;
    const auto asked = analytic::swept_gap(*job.part, shank, m, look);
    if (asked.measured_mm < look.asked_mm) continue;  // a nearer place was found
    undecided += plain.proven_mm < look.asked_mm;
    EXPECT_GE(asked.proven_mm, look.asked_mm) << k;
    EXPECT_LE(asked.proven_mm, asked.measured_mm) << k;
  }
  EXPECT_GT(undecided, 3);
}

}  // namespace
}  // namespace toothpath
