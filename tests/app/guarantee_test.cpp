// docs/guarantee.md: the sentence that it begins with, and a test that exists behind every promise.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/test_names.h"

namespace toothpath::test {
namespace {

const std::string kGuarantee = TOOTHPATH_SOURCE_DIR "/docs/guarantee.md";

TEST(GuaranteePage, BeginsWithItsSentence) {
  EXPECT_TRUE(file_text(kGuarantee).starts_with("# Guarantee\n\n**No NC file without a proven bound.**"));
}

TEST(GuaranteePage, EveryPromiseNamesTestsThatExist) {
  const auto known = tests_in_sources();
  ASSERT_GT(known.size(), 500u);
  std::istringstream in(file_text(kGuarantee));
  std::string section;
  int promises = 0, limits = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("## ")) section = line.substr(3);
    const auto named = tests_named_in(line);
    for (const std::string& test : named) EXPECT_EQ(known.count(test), 1u) << test << ", which no source has";
    if (section == "Promised" && line.starts_with("| ") && !line.starts_with("| what |")) {
      ++promises;
      EXPECT_FALSE(named.empty()) << line;
    }
    limits += section == "Not promised" && line.starts_with("* ");
  }
  EXPECT_GE(promises, 10);
  EXPECT_GE(limits, 3);
}

}  // namespace
}  // namespace toothpath::test
