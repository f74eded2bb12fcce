// What a job says of line milling, tapered mills and regions is read as it stands.
#include <gtest/gtest.h>

#include "app/job/file.h"
#include "geometry/base/angle.h"
#include "tests/app/line_job.h"

namespace toothpath::test {
namespace {

using path::OperationType;
using path::Region;

job::Job read_job(const std::string& path) {
  auto result = job::read_job_file(path);
  if (auto* errors = result.refused()) {
    ADD_FAILURE() << to_text(*errors);
    return {};
  }
  return std::move(result).value();
}
job::Job read_line(const std::string& operations, std::string gear = kLineGear) {
  const TestDir dir;
  write_file(dir / "job.toml", gear + operations);
  write_file(dir / "m.csv", "t,f\n0, 0.0\n1.5,-2.5\n\n3.0,1\r\n");
  return read_job(dir / "job.toml");
}

const std::string kJobs = TOOTHPATH_SOURCE_DIR "/tests/jobs/";

TEST(LineJobFile, QuarterScaleIsRead) {
  const job::Job job = read_job(kJobs + "dhfg_line.toml");
  ASSERT_EQ(job.tools.size(), 3u);
  const auto& mill = job.tools[2];
  EXPECT_EQ(mill.type, tool::CutterType::tapered_ball_end_mill);
  EXPECT_EQ(mill.diameter_mm, 0.5);
  EXPECT_EQ(mill.half_angle_rad, radians(5.0));
  EXPECT_EQ(mill.flute_length_mm, 4.0);
  EXPECT_EQ(mill.shank_diameter_mm, 4.0);
  ASSERT_TRUE(mill.helix_rad.has_value());
  EXPECT_EQ(*mill.helix_rad, radians(30.0));
  EXPECT_FALSE(mill.meridian || mill.run_out_mm || mill.form_error_mm || mill.half_angle_error_rad);
  const OperationType types[] = {OperationType::roughing,     OperationType::roughing,
                                 OperationType::roughing,     OperationType::line_milling,
                                 OperationType::line_milling, OperationType::semi_finishing,
                                 OperationType::line_milling, OperationType::finishing};
  ASSERT_EQ(job.operations.size(), std::size(types));
  for (std::size_t n = 0; n < std::size(types); ++n) EXPECT_EQ(job.operations[n].type, types[n]) << n;
  const auto &rest = job.operations[3], &semi = job.operations[5], &line = job.operations[6], &last = job.operations[7];
  EXPECT_EQ(rest.allowance_mm, 0.05);
  EXPECT_EQ(rest.left_mm, 0.004);
  EXPECT_FALSE(rest.finishes());
  EXPECT_FALSE(rest.strips || rest.rotaries);
  EXPECT_EQ(semi.scallop_mm, 0.02);
  EXPECT_EQ(semi.allowance_mm, 0.012);
  EXPECT_TRUE(line.finishes());
  EXPECT_EQ(line.allowance_mm, 0);
  EXPECT_EQ(line.left_mm, 0.002);
  EXPECT_EQ(line.chord_tolerance_mm, 0.0005);
  EXPECT_EQ(line.tool, 2);
  for (const auto* o : {&semi, &last}) {
    EXPECT_FALSE(o->regions[Region::flank]);
    EXPECT_TRUE(o->regions[Region::fillet] && o->regions[Region::root]);
  }
  EXPECT_TRUE(line.regions[Region::flank] && !line.regions[Region::fillet] && !line.regions[Region::root]);
  EXPECT_EQ(last.scallop_mm, 0.008);
  EXPECT_TRUE(job.warnings.empty());
}

TEST(LineJobFile, PaperScaleIsRead) {
  const job::Job job = read_job(kJobs + "dhfg_paper_line.toml");
  ASSERT_EQ(job.tools.size(), 3u);
  EXPECT_EQ(job.tools[2].diameter_mm, 2.0);
  EXPECT_EQ(job.tools[2].flute_length_mm, 15.0);
  EXPECT_EQ(job.tools[2].shank_diameter_mm, 8.0);
  ASSERT_EQ(job.operations.size(), 8u);
  EXPECT_EQ(job.operations[3].allowance_mm, 0.12);
  EXPECT_EQ(job.operations[3].left_mm, 0.01);
  EXPECT_EQ(job.operations[6].left_mm, 0.006);
  EXPECT_EQ(job.operations[6].feed_mm_min, 700.0);
  EXPECT_EQ(path::finisher_of(job.operations, Region::flank), 6u);
  EXPECT_EQ(path::finisher_of(job.operations, Region::fillet), 7u);
  EXPECT_EQ(path::finisher_of(job.operations, Region::root), 7u);
}

TEST(LineJobFile, KeysOfTheOperation) {
  const job::Job job =
      read_line(operation("line_milling", 1,
                          "strips = 3\nrotaries = \"one\"\nleft = 0.003\nclimb = false\n"
                          "strategy = \"best\"") +
                operation("line_milling", 1, "rotaries = \"both\"\nallowance = 0.02") + kFilletAndRoot);
  ASSERT_EQ(job.operations.size(), 3u);
  EXPECT_EQ(job.operations[0].strips, 3);
  EXPECT_EQ(job.operations[0].rotaries, path::MovingRotaries::one);
  EXPECT_EQ(job.operations[0].most_misfit_mm(), 0.003);
  EXPECT_FALSE(job.operations[0].climb);
  EXPECT_TRUE(job.operations[0].best_way);
  EXPECT_FALSE(job.operations[1].best_way);
  EXPECT_EQ(job.operations[1].rotaries, path::MovingRotaries::both);
  EXPECT_EQ(job.operations[1].most_misfit_mm(), path::MillingOperation::kDefaultLeft);
}

TEST(LineJobFile, ScallopsByRegion) {
  const job::Job job = read_line(operation("finishing", 1, "scallop = {flank = 0.002, fillet = 0.008, root = 0.006}") +
                                 operation("finishing", 2, "regions = [\"root\"]\nscallop = 0.01"));
  const auto &table = job.operations[0], &number = job.operations[1];
  EXPECT_EQ(table.scallop_in(Region::flank), 0.002);
  EXPECT_EQ(table.scallop_in(Region::fillet), 0.008);
  EXPECT_EQ(table.scallop_in(Region::root), 0.006);
  EXPECT_EQ(table.scallop_mm, 0.008);
  EXPECT_EQ(number.scallop_in(Region::root), 0.01);
  EXPECT_TRUE(number.regions[Region::root] && !number.regions[Region::flank] && !number.regions[Region::fillet]);
}

TEST(LineJobFile, MeasuredMillAndPivots) {
  std::string gear = replaced(kLineGear, "flute_length = 6.5",
                              "flute_length = 6.5\nhelix = 0\nmeridian = \"m.csv\"\nform_error = 0.003\nrun_out = "
                              "0.004\nhalf_angle_error = 0.05");
  gear = replaced(gear, "axis = \"up\"", "axis = \"up\"\npivot_error = 0.005");
  const job::Job job = read_line(operation("line_milling", 1, "allowance = 0.05"), gear);
  ASSERT_FALSE(job.tools.empty());
  const auto& mill = job.tools[0];
  ASSERT_TRUE(mill.meridian.has_value());
  EXPECT_EQ(mill.meridian->t, (std::vector<double>{0, 1.5, 3}));
  EXPECT_EQ(mill.meridian->f, (std::vector<double>{0, -0.0025, 0.001}));
  EXPECT_EQ(mill.form_error_mm, 0.003);
  EXPECT_EQ(mill.run_out_mm, 0.004);
  EXPECT_EQ(mill.half_angle_error_rad, radians(0.05));
  EXPECT_EQ(job.setup->pivot_error_mm, 0.005);
  ASSERT_EQ(job.warnings.size(), 1u);
  EXPECT_NE(job.warnings[0].find(":31:9: warning: helix = 0 deg, tool 1"), std::string::npos) << job.warnings[0];
}

TEST(LineJobFile, FlatAndBullNose) {
  const job::Job job = read_line(roughing(3));
  EXPECT_EQ(job.tools[2].type, tool::CutterType::bull_nose_end_mill);
  EXPECT_EQ(job.tools[2].corner_radius_mm, 0.2);
  std::string gear = replaced(kLineGear, "\"bull_nose_end_mill\"", "\"flat_end_mill\"");
  gear = replaced(gear, "corner_radius = 0.2\n", "");
  EXPECT_EQ(read_line(roughing(3), gear).tools[2].type, tool::CutterType::flat_end_mill);
}

}  // namespace
}  // namespace toothpath::test
