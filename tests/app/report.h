// What the program reports: on standard output with --json, and in report.json.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {

/// `report` of what `--json` prints.
inline nlohmann::json report_of(std::vector<std::string> words, int exit_code = 0) {
  words.emplace_back("--json");
  const Finished done = run_program(words);
  EXPECT_EQ(done.exit_code, exit_code) << words.front() << ": " << done.err << done.out.substr(0, 2000);
  const auto json = nlohmann::json::parse(done.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << done.out.substr(0, 300);
  EXPECT_EQ(json["exit_code"], exit_code);
  EXPECT_TRUE(json.contains("report")) << words.front() << " has no data";
  return json.value("report", nlohmann::json::object());
}

inline nlohmann::json report_in(const std::string& folder) {
  return nlohmann::json::parse(file_text(folder + "/report.json"));
}

}  // namespace toothpath::test
