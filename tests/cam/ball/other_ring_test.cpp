// Across the relief groove of a double helical gear stands another ring of teeth: an operation leaves its allowance
// there too, or it is refused with the allowance that would do.
#include <algorithm>

#include "cam/path/asked_stock.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

/// 20/53, module 1.73, a groove of 0.95 mm.
face_gear::FaceGearParameters narrow_groove(double shaft_angle_deg) {
  face_gear::FaceGearParameters g;
  g.teeth = 53;
  g.shaper_teeth = 20;
  g.module_mm = 1.7328;
  g.module_plane = face_gear::ModulePlane::transverse;
  g.pressure_angle_rad = radians(21.06);
  g.addendum_coefficient = 0.9;
  g.shaft_angle_rad = radians(shaft_angle_deg);
  g.shaper_tip_radius_mm = 0.3;
  g.reference_radius_mm = 50.69;
  const double out = shaft_angle_deg > 90 ? 0.4 : 0;  // of the undercut there
  g.zones = {{radians(16.8), 46.714 + out, 49.087 + out}, {radians(-16.8), 50.037 + out, 51.874 + out}};
  g.groove_depth_mm = 5.49;
  return g;
}

/// What the tool leaves on the teeth of all rings at the least, looked at place by place: ball and flute. mm
double least_left(const test::PlannedJob& job) {
  double least = INFINITY;
  for (const path::ClPath& path : job.plan.paths) {
    const tool::ToolAssembly& tool = job.tool(path.operation);
    const double R = tool.radius_mm();
    for (const path::ClRecord& record : path.records)
      for (double above = 0; above <= tool.flute_length_mm - R; above += 0.5 * R) {
        const Vec3 at = record.tip + (R + above) * record.axis;
        least = std::min(least, job.part->nearest(at, R + 0.4).distance - R);
      }
  }
  return least;
}

TEST(OtherRing, RoughingLeavesItsAllowanceThere) {
  for (const auto& [shaft_angle, allowance] : {std::pair{84.365, 0.136}, {99.8, 0.2}}) {
    SCOPED_TRACE(fmt::format("shaft angle {} deg, allowance {} mm", shaft_angle, allowance));
    const auto job = test::planned(narrow_groove(shaft_angle), {test::ball_mill(0.93, 7.4, 1.3, 28, 14)},
                                   {test::roughing(0, 1.2, 0.8, allowance)});
    EXPECT_GE(least_left(job), path::kAskedStock * allowance);
  }
}

TEST(OtherRing, AnAllowanceWithoutRoomIsRefusedAtItsKey) {
  const auto refused = [](double allowance) -> std::string {
    try {
      test::planned(narrow_groove(84.365), {test::ball_mill(0.93, 7.4, 1.3, 28, 14)},
                    {test::roughing(0, 1.2, 0.8, allowance)});
    } catch (const std::runtime_error& why) { return why.what(); }
    return {};
  };
  const std::string why = refused(0.48);
  EXPECT_TRUE(why.starts_with("operation[0].allowance: allowance = 0.48 mm cannot stay on the ring across")) << why;
  const double would_do = test::number_after(why, "is needed; ");
  EXPECT_EQ(refused(would_do), "");
  EXPECT_NE(refused(would_do + 0.002), "");
}

}  // namespace
}  // namespace toothpath
