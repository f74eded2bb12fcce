// Rows 9, 26 and 28 of docs/dangers.md, where they are the business of the program around the post: units of a job,
// times of blocks.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "app/job/file.h"
#include "app/report/block_times.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

// There is one unit of length. A job that asks for another is refused at the place where it does: nothing is scaled, so
// that no angle can be scaled along with a length.
TEST(DangerUnits, JobsInInchesAreRefused) {
  const std::string good = test::file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
  ASSERT_TRUE(job::parse_job(good, "j").has_value());
  const std::pair<std::string, std::string> cases[] = {{"module = 2.0", "module = \"0.0787402 in\""},
                                                       {"module = 2.0", "module = 0.0787402in"},
                                                       {"teeth = 60", "teeth = 60\nunits = \"inch\""},
                                                       {"schema = 1", "schema = 1\nunits = \"inch\""},
                                                       {"[setup]", "[setup]\nunit = \"inch\""},
                                                       {"inner_radius = 60.0", "inner_radius = \"2.36220in\""},
                                                       {"inner_radius = 60.0", "inner_radius_inch = 2.36220"}};
  for (const auto& [from, to] : cases) {
    const auto read = job::parse_job(test::replaced(good, from, to), "j");
    ASSERT_FALSE(read.has_value()) << to;
    EXPECT_GT(read.error().front().position.line, 0) << to;
  }
}

// Every cutting block of one tooth is counted once, in the bin of its time.
TEST(BlockTimes, HistogramCountsEveryBlock) {
  joints::AxisProgram program;
  program.time_rulers = {"feed", "block time", "C"};
  program.time_ruled = {3, 0, 2};
  joints::AxisOperation operation;
  joints::ToothBlocks tooth;
  for (const double ms : {1.0, 1.1, 9.99, 10.0, 250.0}) {
    joints::AxisBlock b;
    b.minutes = ms / 60000;
    tooth.blocks.push_back(b);
    b.kind = joints::BlockKind::rapid_z;
    tooth.blocks.push_back(b);
  }
  operation.teeth = {tooth, tooth};  // the second tooth is the same once more
  program.operations = {operation};
  const report::BlockTimes t = report::block_times_of(program);
  EXPECT_NEAR(t.least_ms, 1, 1e-9);
  EXPECT_NEAR(t.median_ms, 9.99, 1e-9);
  EXPECT_EQ(std::accumulate(t.counts.begin(), t.counts.end(), std::size_t{0}), 5u);
  const auto count_at = [&](double ms) {
    return t.counts.at(static_cast<std::size_t>(std::floor((std::log10(ms) - t.from_log_ms) / t.step_log_ms + 1e-6)));
  };
  EXPECT_EQ(count_at(1.05), 2u);
  EXPECT_EQ(count_at(9.0), 1u);
  EXPECT_EQ(count_at(11.0), 1u);
  EXPECT_EQ(count_at(250.0), 1u);
  EXPECT_EQ(t.ruled, (std::vector<std::pair<std::string, std::size_t>>{{"feed", 3}, {"C", 2}}));
  EXPECT_EQ(report::block_time_chart(t).counts, t.counts);
  EXPECT_TRUE(report::block_times_of(joints::AxisProgram{}).counts.empty());
}

}  // namespace
}  // namespace toothpath
