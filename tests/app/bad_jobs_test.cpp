// Every file in tests/bad_jobs is refused with exactly the diagnostic in its first line, exit code 3, and no file is
// left.
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

std::vector<std::string> bad_jobs(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& name : names_in(folder))
    if (name.ends_with(".toml")) names.push_back(name.substr(0, name.size() - 5));
  return names;
}

/// The file is refused by `command` with exactly the text after "# " in its first line.
void expect_first_line(const std::string& command, const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name + ".toml";
  const std::string text = file_text(path);
  ASSERT_TRUE(text.starts_with("# "));
  const std::string expected = text.substr(2, text.find('\n') - 2);
  const TestDir dir;
  const Finished run = run_program({command, path, "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.err, folder + "/" + expected + "\n");
  EXPECT_TRUE(names_in(dir / "out").empty());
}

class BadJob : public ::testing::TestWithParam<std::string> {};

TEST_P(BadJob, IsRefusedWithItsFirstLine) { expect_first_line("run", kBadJobs, GetParam()); }

INSTANTIATE_TEST_SUITE_P(All, BadJob, ::testing::ValuesIn(bad_jobs(kBadJobs)),
                         [](const auto& job) { return job.param; });

/// Jobs for the gear shaper, refused by `shaper`.
class BadShaperJob : public ::testing::TestWithParam<std::string> {};

TEST_P(BadShaperJob, IsRefusedWithItsFirstLine) { expect_first_line("shaper", kBadJobs + "/shaper", GetParam()); }

INSTANTIATE_TEST_SUITE_P(All, BadShaperJob, ::testing::ValuesIn(bad_jobs(kBadJobs + "/shaper")),
                         [](const auto& job) { return job.param; });

}  // namespace
}  // namespace toothpath::test
