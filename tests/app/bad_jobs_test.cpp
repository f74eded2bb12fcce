// Every file in tests/bad_jobs is refused with exactly the diagnostic in its first line, exit code 3, and no file is left.
#include "program.h"

namespace toothpath::testing {
namespace {

std::vector<std::string> bad_jobs() {
  std::vector<std::string> names;
  for (const auto& name : names_in(kBadJobs))
    if (name.ends_with(".toml")) names.push_back(name.substr(0, name.size() - 5));
  return names;
}

class BadJob : public ::testing::TestWithParam<std::string> {};

TEST_P(BadJob, IsRefusedWithItsFirstLine) {
  const std::string path = kBadJobs + "/" + GetParam() + ".toml";
  const std::string text = file_text(path);
  ASSERT_TRUE(text.starts_with("# "));
  const std::string expected = text.substr(2, text.find('\n') - 2);
  const TestDir dir;
  const Finished run = run_program({"run", path, "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.err, kBadJobs + "/" + expected + "\n");
  EXPECT_TRUE(names_in(dir / "out").empty());
}

INSTANTIATE_TEST_SUITE_P(All, BadJob, ::testing::ValuesIn(bad_jobs()), [](const auto& job) { return job.param; });

}  // namespace
}  // namespace toothpath::testing
