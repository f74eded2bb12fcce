// `check` of many texts of one job.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "app/commands/check.h"

namespace toothpath::test {

/// The job is read, and planned where it is needed, once for all texts.
inline std::unique_ptr<commands::ProgramChecker> checker_of(const std::string& job_file) {
  commands::CheckRequest request;
  request.job_file = job_file;
  request.quiet = true;
  auto checker = std::make_unique<commands::ProgramChecker>(request);
  const auto errors = checker->read();
  EXPECT_TRUE(errors.empty()) << to_text(errors);
  return checker;
}

}  // namespace toothpath::test
