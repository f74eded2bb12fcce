// docs/dangers.md: every danger has a row, every row names tests, every test that is named exists.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/support/files.h"
#include "tests/support/test_names.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;

TEST(DangersTable, EveryRowNamesTestsThatExist) {
  constexpr int kDangers = 35;
  const auto known = test::tests_in_sources();
  ASSERT_GT(known.size(), 500u);
  std::istringstream in(test::file_text(fs::path(TOOTHPATH_SOURCE_DIR) / "docs/dangers.md"));
  const std::regex named(R"(`([A-Za-z0-9]+\.[A-Za-z0-9]+)`)");
  int row = 0;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_search(line, std::regex(R"(^\| \d+ \|)"))) continue;
    ++row;
    EXPECT_EQ(std::stoi(line.substr(2)), row);
    std::vector<std::string> cells;
    std::istringstream columns(line.substr(1));
    for (std::string cell; std::getline(columns, cell, '|');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 5u) << "row " << row;
    int tests = 0;
    for (std::sregex_iterator it(cells[4].begin(), cells[4].end(), named), end; it != end; ++it, ++tests)
      EXPECT_EQ(known.count((*it)[1]), 1u) << "row " << row << " names " << (*it)[1] << ", which no source has";
    EXPECT_GE(tests, 1) << "row " << row;
    // Files that are named are there.
    const std::regex file(R"(`((?:app/(?:report/)?)?[a-z0-9_]+\.(?:cpp|h))`)");
    for (std::sregex_iterator it(cells[3].begin(), cells[3].end(), file), end; it != end; ++it) {
      const std::string name = (*it)[1];
      bool there = false;
      for (const char* folder :
           {"", "postproc/", "postproc/controls/linuxcnc/", "postproc/controls/heidenhain/", "app/", "app/commands/"})
        there = there || fs::exists(fs::path(TOOTHPATH_SOURCE_DIR) / folder / name);
      EXPECT_TRUE(there) << "row " << row << ": " << name;
    }
  }
  EXPECT_EQ(row, kDangers);
}

}  // namespace
}  // namespace toothpath
