// Every control's program is a program: none of an earlier run stays where a new one may appear.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "app/base/output_dir.h"
#include "app/process/program_report.h"
#include "postproc/controls/registry.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

TEST(ProgramExtensions, OldProgramsOfEveryControlGo) {
  const auto extensions = controls::program_extensions();
  ASSERT_GE(extensions.size(), 5u);
  for (const auto* control : controls::all())
    EXPECT_EQ(std::count(extensions.begin(), extensions.end(), control->words.extension), 1) << control->words.name;
  const TestDir dir;
  std::filesystem::create_directory(dir / "out");
  for (const auto& extension : extensions) {
    EXPECT_EQ(extension.front(), '.');
    write_file(dir / ("out/program" + extension), "old");
  }
  write_file(dir / "out/program.txt", "mine");
  auto output = app::OutputDir::open(dir / "out", {"program."}, {}, "previous");
  ASSERT_TRUE(output) << output.error().text();
  const auto set_aside = output->set_aside();
  ASSERT_TRUE(set_aside) << set_aside.error().text();
  for (const auto& extension : extensions) {
    EXPECT_FALSE(std::filesystem::exists(dir / ("out/program" + extension))) << extension;
    EXPECT_TRUE(std::filesystem::exists(dir / ("out/previous/program" + extension))) << extension;
  }
  EXPECT_TRUE(std::filesystem::exists(dir / "out/program.txt"));
}

// Two jobs on one control do not call each other's sub-programs.
TEST(ProgramNumbers, FollowTheJob) {
  job::Job job;
  std::map<int, int> jobs;
  for (int n = 0; n < 400; ++n) {
    job.name = "gear " + std::to_string(n);
    const int number = process::program_number(job);
    EXPECT_EQ(number, process::program_number(job));
    EXPECT_EQ(number % 100, 0);
    EXPECT_GE(number, 1000);
    EXPECT_LE(number, 6900);
    ++jobs[number];
  }
  EXPECT_GT(jobs.size(), 55U);
  for (const auto& [number, count] : jobs) EXPECT_LT(count, 20) << number;
  job.program.number = 1234;
  EXPECT_EQ(process::program_number(job), 1234);
}

}  // namespace
}  // namespace toothpath::test
