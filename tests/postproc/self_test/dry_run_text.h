// The text of a dry run, as `machine test` writes it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "postproc/controls/of_machine.h"
#include "postproc/self_test/self_test.h"
#include "postproc/text/writer.h"

namespace toothpath::test {

inline std::string dry_run_text(const self_test::SelfTest& test, const machines::Machine& m) {
  const auto dialect = controls::dialect_of(m);
  EXPECT_TRUE(dialect) << dialect.error().message;
  text::NcHeader header;
  header.job_name = "self test";
  const auto text =
      text::write_nc(self_test::self_test_program(test, m, *dialect), self_test::in_air(*dialect), header);
  EXPECT_TRUE(text) << text.error().message;
  return text ? text->text : std::string();
}

}  // namespace toothpath::test
