// What is known of every control, from one place.
#include <gtest/gtest.h>

#include "postproc/work_offset.h"

namespace toothpath {
namespace {

TEST(Controls, WorkOffsetsOfAnUnknownControlAreRefused) {
  EXPECT_TRUE(other_work_offsets("grbl", "G54"));
  EXPECT_TRUE(other_work_offsets("", "G54"));
  EXPECT_FALSE(other_work_offsets("linuxcnc", "G54"));
  EXPECT_FALSE(other_work_offsets("apt", "G54"));
}

}  // namespace
}  // namespace toothpath
