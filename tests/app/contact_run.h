// Runs of `contact` on samples with a piece of text replaced.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/app/program.h"

namespace toothpath::test {

using Json = nlohmann::json;

/// Text of a sample with one piece replaced, in a file of the test's directory.
inline std::string changed_sample(const TestDir& dir, const std::string& sample, const std::string& from,
                                  const std::string& to) {
  std::string text = file_text(kSamples + "/" + sample);
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument("no " + from);
  text.replace(at, from.size(), to);
  const std::string path = dir / sample.substr(sample.find_last_of('/') + 1);
  write_file(path, text);
  return path;
}

inline Json contact_of(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const auto done = run_program(arguments);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  return Json::parse(done.out).at("report");
}

}  // namespace toothpath::test
