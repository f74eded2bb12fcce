// Names of the tests, for pages that say which test holds what they promise.
#pragma once

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace toothpath::test {

/// "Suite.Name" of every GoogleTest case in the sources under tests.
inline std::set<std::string> tests_in_sources() {
  std::set<std::string> names;
  const std::regex test(R"((?:^|\n)TEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(TOOTHPATH_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = file_text(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it)
      names.insert((*it)[1].str() + "." + (*it)[2].str());
  }
  return names;
}

/// Every `Suite.Name` in backquotes, in order.
inline std::vector<std::string> tests_named_in(const std::string& text) {
  static const std::regex named(R"(`([A-Za-z0-9]+\.[A-Za-z0-9]+)`)");
  std::vector<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) names.push_back((*it)[1]);
  return names;
}

}  // namespace toothpath::test
