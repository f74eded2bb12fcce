// Every control's program is a program: no command leaves one of an earlier run where a new one may appear.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/output_dir.h"
#include "postproc/nc_dialect.h"
#include "program.h"

namespace toothpath::test {
namespace {

TEST(ProgramExtensions, OldProgramsOfEveryControlGo) {
  const auto extensions = program_extensions();
  ASSERT_GE(extensions.size(), 5u);
  for (const auto& name : dialect_names()) {
    const auto dialect = find_dialect(name);
    ASSERT_TRUE(dialect);
    EXPECT_EQ(std::count(extensions.begin(), extensions.end(), dialect->extension), 1) << name;
  }
  const TestDir dir;
  std::filesystem::create_directory(dir / "out");
  for (const auto& extension : extensions) {
    EXPECT_EQ(extension.front(), '.');
    write_file(dir / ("out/program" + extension), "old");
  }
  write_file(dir / "out/program.txt", "mine");
  const auto output = OutputDir::open(dir / "out", {"program."});
  ASSERT_TRUE(output) << output.error().text();
  for (const auto& extension : extensions) EXPECT_FALSE(std::filesystem::exists(dir / ("out/program" + extension))) << extension;
  EXPECT_TRUE(std::filesystem::exists(dir / "out/program.txt"));
}

}  // namespace
}  // namespace toothpath::test
