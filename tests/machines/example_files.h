// A good machine file to damage.
#pragma once

#include "tests/support/files.h"

namespace toothpath::test {

inline constexpr const char* kMachine = R"(schema = 1
name = "example"
kind = "five_axis"
dialect = "linuxcnc"
tcp = "none"
assumed = false
max_simultaneous_axes = 5

[spindle]
max_speed = 24000

[limits]
cutting_feed = 10000
table_diameter = 500
min_block_ms = 1.0

[chain]
table = ["C", "A"]
head = []

[axes.X]
min = -300.0
max = 300.0
max_speed = 30000

[axes.Y]
min = -250.0
max = 250.0
max_speed = 30000

[axes.Z]
min = -400.0
max = 0.0
max_speed = 20000

[axes.A]
direction = [1.0, 0.0, 0.0]
point = [0.0, 0.0, -285.0]
sign = 1
min = -110.0
max = 30.0
max_speed = 6000

[axes.C]
direction = [0.0, 0.0, 1.0]
point = [0.0, 0.0, 0.0]
sign = 1
min = -36000.0
max = 36000.0
max_speed = 12000
)";

inline constexpr std::size_t kMaxBytesForTest = 1u << 20;

}  // namespace toothpath::test
